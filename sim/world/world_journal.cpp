// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world_journal.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "sim/acoustics/channel.hpp"
#include "sim/acoustics/transducer.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/data_files.hpp"
#include "sim/world_file/vehicle_loader.hpp"

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
  archive(kind, step, name, values, in_file, text_number, bus, X_W, new_surfaces, number, numbers, devices, transducers,
          joints);
}

std::size_t WorldJournal::Entry::bytes() const {
  constexpr std::size_t always = 320;
  const std::size_t numbers_in_lists =
      numbers.bodies.size() + numbers.parts.size() + numbers.joints.size() + devices.size() + transducers.size();
  return always + name.size() + values.size() + bus.size() + numbers_in_lists * sizeof(int) +
         joints.size() * sizeof(JointPlace);
}

WorldJournal::Entry WorldJournal::entry(Kind kind, const std::string& name) const {
  Entry entry;
  entry.kind = kind;
  entry.step = world_.step_number();
  entry.name = name;
  return entry;
}

Bytes WorldJournal::bytes() const {
  StateArchive archive = StateArchive::saver(size_);
  auto& self = const_cast<WorldJournal&>(*this);  // saving changes nothing
  std::vector<std::pair<std::int64_t, std::string>> texts;
  for (const auto& [number, text] : texts_) texts.emplace_back(number, text.text);
  auto devices = static_cast<std::int64_t>(world_.devices_.size());
  archive(texts, self.entries_, world_.free_numbers_, devices);
  return archive.take_bytes();
}

void WorldJournal::append(Entry entry) {
  use_text(entry.text_number);
  size_ += entry.bytes();
  entries_.push_back(std::move(entry));
  check_size();
}

void WorldJournal::check_size() {
  if (size_ <= most_bytes) return;
  forget();
  full_ = true;
  gap_ = "more came and was changed than can be told in 16 MiB";
}

void WorldJournal::forget() {
  entries_ = {};
  texts_.clear();
  text_numbers_.clear();
  parsed_.clear();
  vehicles_.clear();
  size_ = 0;
}

void WorldJournal::drop(std::size_t place) {
  const auto at = entries_.begin() + static_cast<std::ptrdiff_t>(place);
  size_ -= at->bytes();
  let_go_of_text(at->text_number);
  entries_.erase(at);
}

std::optional<std::size_t> WorldJournal::place_of(Kind came, const std::string& name) const {
  for (std::size_t i = entries_.size(); i-- > 0;)
    if (entries_[i].kind == came && entries_[i].name == name) return i;
  return std::nullopt;
}

void WorldJournal::drop_changes_of(const std::string& name, std::size_t first) {
  for (std::size_t i = entries_.size(); i-- > first;) {
    const Entry& entry = entries_[i];
    const bool change = entry.kind == Kind::device_changed && entry.name.starts_with(name + "/");
    if (change || (entry.kind == Kind::moved && entry.name == name)) drop(i);
  }
}

void WorldJournal::use_text(std::int64_t number) {
  if (number >= 0) ++texts_.at(number).users;
}

void WorldJournal::let_go_of_text(std::int64_t number) {
  if (number < 0) return;
  const auto text = texts_.find(number);
  if (--text->second.users > 0) return;
  size_ -= text->second.text.size();
  text_numbers_.erase(text->second.text);
  texts_.erase(text);
}

/// The lowest number that is free.
void WorldJournal::note_source(Entry& entry, const ConfigNode& source) {
  std::string text = text_of(source);
  if (const auto known = text_numbers_.find(text); known != text_numbers_.end()) {
    entry.text_number = known->second;
    return;
  }
  entry.text_number = 0;
  for (const auto& [number, other] : texts_) entry.text_number += number == entry.text_number;
  size_ += text.size();
  text_numbers_.emplace(text, entry.text_number);
  texts_[entry.text_number].text = std::move(text);
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
  if (instance.config->source) return note_source(entry, *instance.config->source);
  for (std::size_t i = 0; i < world_.config().vehicles.size(); ++i)
    if (world_.config().vehicles[i].config == instance.config) entry.in_file = static_cast<std::int64_t>(i);
  if (entry.in_file < 0 && gap_.empty()) gap_ = "vehicle '" + instance.name + "' did not come from YAML";
}

void WorldJournal::vehicle_came(const VehicleInstance& instance, int number, bool new_surfaces) {
  if (full_) return;
  Entry came = entry(Kind::vehicle_came, instance.name);
  note_vehicle(came, instance);
  came.new_surfaces = new_surfaces;
  came.number = number;
  const Vehicle& vehicle = world_.vehicle_named(instance.name);
  came.numbers = world_.physics_->numbers_of(vehicle.group());
  for (const MountedDevice* device : vehicle.devices()) came.devices.push_back(device->number());
  for (const Transducer* transducer : world_.acoustics_->transducers())
    if (transducer != nullptr && transducer->group() == vehicle.group())
      came.transducers.push_back(transducer->number());
  append(std::move(came));
}

void WorldJournal::vehicle_failed(const VehicleInstance& instance, bool new_surfaces) {
  // What is in the world file has brought its surfaces at the start.
  if (full_ || !new_surfaces || !instance.config->source) return;
  Entry surfaces = entry(Kind::surfaces, instance.name);
  note_vehicle(surfaces, instance);
  append(std::move(surfaces));
}

void WorldJournal::vehicle_went(const std::string& name) {
  if (full_) return;
  const std::optional<std::size_t> came = place_of(Kind::vehicle_came, name);
  drop_changes_of(name, came.value_or(0));
  if (!came) return append(entry(Kind::vehicle_went, name));
  Entry& gone = entries_[*came];
  if (!gone.new_surfaces || gone.text_number < 0) return drop(*came);
  // They stay, and keep their numbers: the place among the others counts.
  size_ -= gone.bytes();
  Entry surfaces;
  surfaces.step = gone.step;
  surfaces.name = name;
  surfaces.text_number = gone.text_number;
  gone = std::move(surfaces);
  size_ += gone.bytes();
}

void WorldJournal::object_came(const ObjectConfig& config, const WorldObject& object, const Pose& X_WE) {
  if (full_) return;
  Entry came = entry(Kind::object_came, object.name);
  came.X_W = X_WE;
  came.number = object.number;
  came.numbers = world_.physics_->numbers_of(object.group);
  came.in_file = place_in(world_.config().objects, &config);
  if (came.in_file < 0 && config.source) note_source(came, *config.source);
  if (came.in_file < 0 && !config.source && gap_.empty()) gap_ = "object '" + object.name + "' did not come from YAML";
  append(std::move(came));
}

void WorldJournal::object_went(const std::string& name) {
  if (full_) return;
  const std::optional<std::size_t> came = place_of(Kind::object_came, name);
  came ? drop(*came) : append(entry(Kind::object_went, name));
}

/// One entry for each device, with all values that were changed: some may be possible only together.
void WorldJournal::device_changed(const std::string& full_name, const ConfigNode& values) {
  if (full_) return;
  const auto is_set_again = [&](const ConfigNode::Entry& old) {
    return std::any_of(values.entries.begin(), values.entries.end(), [&](const ConfigNode::Entry& value) {
      return old.key == value.key || old.key.starts_with(value.key + ".");
    });
  };
  ConfigNode all = values;
  if (const auto known = place_of(Kind::device_changed, full_name)) {
    Diagnostics diagnostics;
    ConfigNode before = parse_config_text(entries_[*known].values, "journal", diagnostics);
    std::erase_if(before.entries, is_set_again);
    all.entries.insert(all.entries.begin(), before.entries.begin(), before.entries.end());
    drop(*known);
  }
  Entry changed = entry(Kind::device_changed, full_name);
  changed.values = to_yaml(all);
  append(std::move(changed));
}

/// Joints that are made anew are the last ones: so is the entry.
void WorldJournal::anchored_vehicle_moved(const Vehicle& vehicle) {
  if (full_) return;
  if (const auto known = place_of(Kind::moved, vehicle.name())) drop(*known);
  Entry moved = entry(Kind::moved, vehicle.name());
  moved.joints = world_.physics_->joint_places(vehicle.group());
  append(std::move(moved));
}

}  // namespace sim
