#include "sim/world/world_journal.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "sim/acoustics/channel.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/world/load_world.hpp"
#include "sim/world/vehicle_loader.hpp"
#include "sim/world/world.hpp"

namespace sim {

namespace {

/// The place of an element in a list; -1: it is not in there.
template <typename T>
std::int64_t place_in(const std::vector<T>& list, const T* element) {
  for (std::size_t i = 0; i < list.size(); ++i)
    if (&list[i] == element) return static_cast<std::int64_t>(i);
  return -1;
}

std::string text_of(const ConfigNode& source) {
  ConfigNode node = source;
  make_paths_absolute(node);
  return to_yaml(node);
}

}  // namespace

void WorldJournal::Entry::visit_state(StateArchive& archive) {
  archive(kind, step, name, text, in_file, text_number, bus, X_W, number, new_surfaces, free_numbers, devices);
}

WorldJournal::Entry WorldJournal::entry(Kind kind, const std::string& name) const {
  Entry entry;
  entry.kind = kind;
  entry.step = world_.step_number();
  entry.name = name;
  return entry;
}

void WorldJournal::append(Entry entry) {
  if (full_) return;
  StateArchive archive = StateArchive::saver();
  archive(entry);
  const std::vector<std::byte> bytes = archive.take_bytes();
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  const std::int64_t text_number = entry.kind == Kind::text ? entry.number : entry.text_number;
  noted_.push_back(
      {entry.kind, std::move(entry.name), std::move(entry.text), text_number, entry.new_surfaces, bytes.size()});
  if (bytes_.size() <= most_bytes) return;
  full_ = true;
  if (gap_.empty()) gap_ = "more came, went and was changed than can be told in 16 MiB";
  bytes_ = {};
  noted_ = {};
  texts_.clear();
}

void WorldJournal::drop(std::size_t number) {
  std::ptrdiff_t begin = 0;
  for (std::size_t i = 0; i < number; ++i) begin += static_cast<std::ptrdiff_t>(noted_[i].bytes);
  const auto from = bytes_.begin() + begin;
  bytes_.erase(from, from + static_cast<std::ptrdiff_t>(noted_[number].bytes));
  noted_.erase(noted_.begin() + static_cast<std::ptrdiff_t>(number));
}

void WorldJournal::drop_all_of(const std::string& name, std::size_t first) {
  for (std::size_t i = noted_.size(); i-- > first;)
    if (noted_[i].name == name || noted_[i].name.starts_with(name + "/")) drop(i);
}

std::optional<std::size_t> WorldJournal::came_last(Kind kind, const std::string& name) const {
  for (std::size_t i = noted_.size(); i-- > 0;) {
    const Kind other = noted_[i].kind;
    if (other == kind && noted_[i].name == name) return i;
    if (other == Kind::vehicle_came || other == Kind::object_came || other == Kind::surfaces) return std::nullopt;
  }
  return std::nullopt;
}

std::int64_t WorldJournal::number_of(const std::string& text) {
  if (full_) return 0;
  const auto known = texts_.find(text);
  if (known != texts_.end()) return known->second;
  std::set<std::int64_t> taken;
  for (const auto& [other, number] : texts_) taken.insert(number);
  Entry noted = entry(Kind::text, "");
  while (taken.contains(noted.number)) ++noted.number;
  noted.text = text;
  const std::int64_t number = noted.number;
  texts_.emplace(text, number);
  append(std::move(noted));
  return number;
}

void WorldJournal::drop_unused_texts() {
  std::set<std::int64_t> used;
  for (const Noted& noted : noted_)
    if (noted.kind != Kind::text) used.insert(noted.text_number);
  for (std::size_t i = noted_.size(); i-- > 0;)
    if (noted_[i].kind == Kind::text && !used.contains(noted_[i].text_number)) drop(i);
  std::erase_if(texts_, [&](const auto& text) { return !used.contains(text.second); });
}

bool WorldJournal::has_new_surfaces(const VehicleConfig& config) const {
  const auto new_category = [&](const std::string& name) {
    try {
      world_.physics_->category_bit(name);
      return false;
    } catch (const std::out_of_range&) {
      return true;
    }
  };
  const auto new_material = [&](const MaterialConfig& each) { return !world_.known_materials_.contains(each.name); };
  const std::vector<ContactConfig>& known = world_.known_contacts_;
  const auto new_contact = [&](const ContactConfig& each) {
    return std::find(known.begin(), known.end(), each) == known.end();
  };
  return std::any_of(config.categories.begin(), config.categories.end(), new_category) ||
         std::any_of(config.materials.begin(), config.materials.end(), new_material) ||
         std::any_of(config.contacts.begin(), config.contacts.end(), new_contact);
}

void WorldJournal::note_vehicle(Entry& entry, const VehicleInstance& instance) {
  entry.bus = instance.bus;
  entry.X_W = instance.X_WV;
  if (instance.config->source) {
    entry.text_number = number_of(text_of(*instance.config->source));
    return;
  }
  for (std::size_t i = 0; i < world_.config().vehicles.size(); ++i)
    if (world_.config().vehicles[i].config == instance.config) entry.in_file = static_cast<std::int64_t>(i);
  if (entry.in_file < 0 && gap_.empty()) gap_ = "vehicle '" + instance.name + "' did not come from YAML";
}

void WorldJournal::vehicle_came(const VehicleInstance& instance, int number, bool new_surfaces) {
  Entry came = entry(Kind::vehicle_came, instance.name);
  note_vehicle(came, instance);
  came.number = number;
  came.new_surfaces = new_surfaces;
  append(std::move(came));
}

void WorldJournal::vehicle_failed(const VehicleInstance& instance, bool new_surfaces) {
  Entry failed = entry(Kind::surfaces, instance.name);
  if (new_surfaces) note_vehicle(failed, instance);
  // What is in the world file has brought its surfaces at the start.
  if (failed.text_number >= 0) note_surfaces(instance.name, failed.text_number);
  note_numbers();
}

void WorldJournal::note_surfaces(const std::string& name, std::int64_t text_number) {
  Entry surfaces = entry(Kind::surfaces, name);
  surfaces.text_number = text_number;
  append(std::move(surfaces));
}

/// Only who comes later takes numbers: until somebody comes, the last numbers count.
void WorldJournal::note_numbers() {
  for (std::size_t i = noted_.size(); i-- > 0 && noted_[i].kind != Kind::vehicle_came;)
    if (noted_[i].kind == Kind::numbers) drop(i);
  Entry numbers = entry(Kind::numbers, "");
  numbers.free_numbers = world_.free_numbers_;
  numbers.devices = static_cast<std::int64_t>(world_.devices_.size());
  append(std::move(numbers));
}

void WorldJournal::vehicle_went(const std::string& name) {
  const std::optional<std::size_t> came = came_last(Kind::vehicle_came, name);
  if (!came || noted_[*came].text_number < 0) return append(entry(Kind::vehicle_went, name));
  const std::int64_t text_number = noted_[*came].text_number;
  const bool new_surfaces = noted_[*came].new_surfaces;
  drop_all_of(name, *came);
  if (new_surfaces) note_surfaces(name, text_number);
  note_numbers();
  drop_unused_texts();
}

void WorldJournal::object_came(const ObjectConfig& config, const std::string& name, const Pose& X_WE,
                               std::int64_t number) {
  Entry came = entry(Kind::object_came, name);
  came.X_W = X_WE;
  came.number = number;
  came.in_file = place_in(world_.config().objects, &config);
  if (came.in_file < 0 && config.source) came.text_number = number_of(text_of(*config.source));
  if (came.in_file < 0 && !config.source && gap_.empty()) gap_ = "object '" + name + "' did not come from YAML";
  append(std::move(came));
}

void WorldJournal::object_went(const std::string& name) {
  const std::optional<std::size_t> came = came_last(Kind::object_came, name);
  if (!came) return append(entry(Kind::object_went, name));
  drop_all_of(name, *came);
  drop_unused_texts();
}

/// One entry for each device, with all values that were changed: some may be possible only together.
void WorldJournal::device_changed(const std::string& full_name, const ConfigNode& values) {
  const std::string vehicle = full_name.substr(0, full_name.find('/'));
  const auto is_set_again = [&](const ConfigNode::Entry& old) {
    return std::any_of(values.entries.begin(), values.entries.end(), [&](const ConfigNode::Entry& value) {
      return old.key == value.key || old.key.starts_with(value.key + ".");
    });
  };
  ConfigNode all = values;
  for (std::size_t i = noted_.size(); i-- > 0;) {
    if (noted_[i].kind == Kind::vehicle_came && noted_[i].name == vehicle) break;
    if (noted_[i].kind != Kind::device_changed || noted_[i].name != full_name) continue;
    Diagnostics diagnostics;
    ConfigNode before = parse_config_text(noted_[i].text, "journal", diagnostics);
    std::erase_if(before.entries, is_set_again);
    all.entries.insert(all.entries.begin(), before.entries.begin(), before.entries.end());
    drop(i);
    break;
  }
  Entry changed = entry(Kind::device_changed, full_name);
  changed.text = to_yaml(all);
  append(std::move(changed));
}

void WorldJournal::anchored_vehicle_moved(const std::string& name, const Pose& X_move_W) {
  Entry moved = entry(Kind::moved, name);
  moved.X_W = X_move_W;
  append(std::move(moved));
}

void WorldJournal::replay(std::span<const std::byte> bytes, std::int64_t last_step) {
  bytes_.clear();
  texts_.clear();
  noted_.clear();
  gap_.clear();
  full_ = false;
  known_texts_.clear();
  parsed_.clear();
  vehicles_.clear();
  StateArchive archive = StateArchive::restorer(bytes);
  std::int64_t earliest = 0;
  try {
    while (archive.bytes_left() > 0) {
      Entry entry;
      archive(entry);
      if (entry.step < earliest || entry.step > last_step)
        throw SnapshotError("the snapshot tells of changes in an order that cannot be");
      earliest = entry.step;
      apply(entry);
      append(std::move(entry));
    }
  } catch (const ConfigError& error) {
    throw SnapshotError("what came to the world before the snapshot cannot come again: " + error.lines().front());
  } catch (const WorldError& error) {
    throw SnapshotError(std::string("what happened to the world before the snapshot cannot happen again: ") +
                        error.what());
  }
  known_texts_.clear();
  parsed_.clear();
  vehicles_.clear();
}

void WorldJournal::apply(const Entry& entry) {
  world_.step_number_ = entry.step;
  world_.medium_.advance_to(world_.now());
  switch (entry.kind) {
    case Kind::text:
      known_texts_[entry.number] = entry.text;
      texts_[entry.text] = entry.number;
      return;
    case Kind::vehicle_came:
      return apply_vehicle(entry);
    case Kind::surfaces:
      return world_.bring_surfaces(*vehicle_config(entry));
    case Kind::numbers:
      return apply_numbers(entry);
    case Kind::vehicle_went:
      return world_.take_apart(world_.vehicle_named(entry.name));
    case Kind::object_came:
      return apply_object(entry);
    case Kind::object_went:
      return world_.take_apart(world_.object_named(entry.name));
    case Kind::device_changed: {
      Diagnostics diagnostics;
      const ConfigNode values = parse_config_text(entry.text, "snapshot", diagnostics);
      diagnostics.throw_if_any();
      world_.apply_change(entry.name, values, diagnostics);
      diagnostics.throw_if_any();
      return;
    }
    case Kind::moved:
      return world_.physics_->move_group(world_.vehicle_named(entry.name).group(), entry.X_W);
  }
  throw SnapshotError("the snapshot tells of a change of a kind that is none");
}

void WorldJournal::apply_vehicle(const Entry& entry) {
  if (entry.number < 0 || entry.number > 100'000'000) throw SnapshotError("the snapshot has a vehicle of no number");
  VehicleInstance instance;
  instance.name = entry.name;
  instance.X_WV = entry.X_W;
  instance.bus = entry.bus;
  instance.config = vehicle_config(entry);
  world_.bring_surfaces(*instance.config);
  world_.next_vehicle_number_ = static_cast<int>(entry.number);
  world_.build_vehicle(instance);
}

void WorldJournal::apply_numbers(const Entry& entry) {
  const auto devices = static_cast<std::size_t>(entry.devices);
  if (devices < world_.devices_.size() || devices > world_.devices_.size() + entry.free_numbers.size())
    throw SnapshotError("the snapshot has numbers of devices that cannot be");
  for (const int number : entry.free_numbers)
    if (number < 0 || number >= entry.devices ||
        (static_cast<std::size_t>(number) < world_.devices_.size() &&
         world_.devices_[static_cast<std::size_t>(number)]))
      throw SnapshotError("the snapshot has numbers of devices that cannot be");
  std::vector<int> sorted = entry.free_numbers;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    throw SnapshotError("the snapshot has numbers of devices that cannot be");
  world_.devices_.resize(devices);
  world_.free_numbers_ = entry.free_numbers;
}

void WorldJournal::apply_object(const Entry& entry) {
  world_.next_object_number_ = entry.number;
  if (entry.in_file >= 0) {
    if (entry.in_file >= static_cast<std::int64_t>(world_.config().objects.size()))
      throw SnapshotError("the snapshot has an object that the world file has not");
    world_.place_object(world_.config().objects[static_cast<std::size_t>(entry.in_file)], entry.name, entry.X_W);
  } else {
    world_.place_object(object_config(entry), entry.name, entry.X_W);
  }
}

const ConfigNode& WorldJournal::parsed(std::int64_t text_number) {
  const auto text = known_texts_.find(text_number);
  if (text == known_texts_.end()) throw SnapshotError("the snapshot tells of a vehicle or object without its YAML");
  const auto [found, fresh] = parsed_.try_emplace(text_number);
  if (fresh) {
    Diagnostics diagnostics;
    found->second = parse_config_text(text->second, "snapshot", diagnostics);
    diagnostics.throw_if_any();
  }
  return found->second;
}

std::shared_ptr<const VehicleConfig> WorldJournal::vehicle_config(const Entry& entry) {
  if (entry.text_number < 0) {
    if (entry.in_file < 0 || entry.in_file >= static_cast<std::int64_t>(world_.config().vehicles.size()))
      throw SnapshotError("the snapshot has a vehicle that the world file has not");
    return world_.config().vehicles[static_cast<std::size_t>(entry.in_file)].config;
  }
  const auto [found, fresh] = vehicles_.try_emplace(entry.text_number);
  if (fresh) {
    Diagnostics diagnostics;
    found->second =
        VehicleLoader(world_.config(), diagnostics).read(parsed(entry.text_number), "vehicle '" + entry.name + "'");
    diagnostics.throw_if_any();
  }
  return found->second;
}

ObjectConfig WorldJournal::object_config(const Entry& entry) {
  Diagnostics diagnostics;
  ParamReader in(parsed(entry.text_number), "object '" + entry.name + "'", diagnostics);
  declare_surfaces(in, world_.config());
  ObjectConfig config;
  config.read(in);
  in.finish();
  diagnostics.throw_if_any();
  return config;
}

}  // namespace sim
