#include "sim/world/world_journal.hpp"

#include <algorithm>

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
  archive(kind, step, name, text, keys, in_file, text_number, bus, X_W, number, free_numbers, devices);
}

WorldJournal::Entry WorldJournal::entry(Kind kind, const std::string& name) const {
  Entry entry;
  entry.kind = kind;
  entry.step = world_.step_number();
  entry.name = name;
  return entry;
}

void WorldJournal::append(Entry entry) {
  StateArchive archive = StateArchive::saver();
  archive(entry);
  const std::vector<std::byte> bytes = archive.take_bytes();
  noted_.push_back({entry.kind, entry.name, entry.keys, entry.text_number, bytes.size()});
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
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
  const auto [known, fresh] = texts_.try_emplace(text, static_cast<std::int64_t>(texts_.size()));
  if (fresh) {
    Entry noted = entry(Kind::text, "");
    noted.text = text;
    append(std::move(noted));
  }
  return known->second;
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

void WorldJournal::vehicle_came(const VehicleInstance& instance, int number) {
  Entry came = entry(Kind::vehicle_came, instance.name);
  note_vehicle(came, instance);
  came.number = number;
  append(std::move(came));
}

void WorldJournal::vehicle_failed(const VehicleInstance& instance) {
  Entry failed = entry(Kind::surfaces, instance.name);
  note_vehicle(failed, instance);
  note_what_stayed(instance.name, failed.text_number, failed.in_file);
}

void WorldJournal::note_what_stayed(const std::string& name, std::int64_t text_number, std::int64_t in_file) {
  const auto brought = [&](const Noted& noted) {
    return (noted.kind == Kind::surfaces || noted.kind == Kind::vehicle_came) && noted.text_number == text_number;
  };
  // What is in the world file has brought its surfaces at the start.
  if (in_file < 0 && std::none_of(noted_.begin(), noted_.end(), brought)) {
    Entry surfaces = entry(Kind::surfaces, name);
    surfaces.text_number = text_number;
    append(std::move(surfaces));
  }
  // Only who comes later takes numbers: until somebody comes, the last numbers count.
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
  drop_all_of(name, *came);
  note_what_stayed(name, text_number, -1);
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
  if (const std::optional<std::size_t> came = came_last(Kind::object_came, name))
    drop_all_of(name, *came);
  else
    append(entry(Kind::object_went, name));
}

void WorldJournal::device_changed(const std::string& full_name, const ConfigNode& values) {
  Entry changed = entry(Kind::device_changed, full_name);
  changed.text = to_yaml(values);
  for (const ConfigNode::Entry& value : values.entries) changed.keys += value.key + " ";
  const std::string vehicle = full_name.substr(0, full_name.find('/'));
  for (std::size_t i = noted_.size(); i-- > 0 && noted_[i].name != vehicle;)
    if (noted_[i].kind == Kind::device_changed && noted_[i].name == full_name && noted_[i].keys == changed.keys) {
      drop(i);  // these values count no more
      break;
    }
  append(std::move(changed));
}

void WorldJournal::anchored_vehicle_moved(const std::string& name, const Pose& X_move_W) {
  Entry moved = entry(Kind::moved, name);
  moved.X_W = X_move_W;
  append(std::move(moved));
}

void WorldJournal::replay(std::span<const std::byte> bytes) {
  bytes_.clear();
  texts_.clear();
  noted_.clear();
  gap_.clear();
  known_texts_.clear();
  parsed_.clear();
  vehicles_.clear();
  StateArchive archive = StateArchive::restorer(bytes);
  try {
    while (archive.bytes_left() > 0) {
      Entry entry;
      archive(entry);
      apply(entry);
      if (entry.kind != Kind::text) append(std::move(entry));
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
      known_texts_.push_back(entry.text);
      number_of(entry.text);
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
  if (text_number < 0 || text_number >= static_cast<std::int64_t>(known_texts_.size()))
    throw SnapshotError("the snapshot tells of a vehicle or object without its YAML");
  const auto [found, fresh] = parsed_.try_emplace(text_number);
  if (fresh) {
    Diagnostics diagnostics;
    found->second = parse_config_text(known_texts_[static_cast<std::size_t>(text_number)], "snapshot", diagnostics);
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
