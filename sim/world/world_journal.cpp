// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/world_journal.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "sim/acoustics/channel.hpp"
#include "sim/acoustics/transducer.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/world/world_parts.hpp"
#include "sim/world_file/data_files.hpp"

namespace sim {

namespace {

/// Returns the index of an element in a list; -1: not found.
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

void JournalEntry::visit_state(StateArchive& archive) {
  archive(kind, step, name, values, in_file, text_number, bus, X_W, new_surfaces, number, numbers, devices, transducers,
          joints);
}

std::size_t JournalEntry::bytes() const {
  constexpr std::size_t always = 320;
  const std::size_t numbers_in_lists =
      numbers.bodies.size() + numbers.parts.size() + numbers.joints.size() + devices.size() + transducers.size();
  return always + name.size() + values.size() + bus.size() + numbers_in_lists * sizeof(int) +
         joints.size() * sizeof(JointPlace);
}

WorldJournal::Entry WorldJournal::entry(Entry::Kind kind, const std::string& name) const {
  Entry entry;
  entry.kind = kind;
  entry.step = parts_.clock.step_number;
  entry.name = name;
  return entry;
}

Bytes WorldJournal::bytes() const {
  StateArchive archive = StateArchive::saver(size_);
  auto& self = const_cast<WorldJournal&>(*this);  // saving does not modify the state
  Texts texts;
  for (const auto& [number, text] : texts_) texts.emplace_back(number, text.text);
  std::vector<int> free = parts_.devices.free_numbers();
  auto devices = static_cast<std::int64_t>(parts_.devices.size());
  archive(texts, self.entries_, free, devices);
  return archive.take_bytes();
}

void WorldJournal::append(Entry entry) {
  use_text(entry.text_number);
  size_ += entry.bytes();
  entries_.push_back(std::move(entry));
  check_size();
}

void WorldJournal::check_size() {
  if (size_ <= max_bytes) return;
  discard();
  full_ = true;
  gap_ = "the change journal exceeds 16 MiB";
}

void WorldJournal::discard() {
  entries_ = {};
  texts_.clear();
  text_numbers_.clear();
  size_ = 0;
}

void WorldJournal::start_again(const Texts& texts) {
  discard();
  gap_.clear();
  full_ = false;
  for (const auto& [number, text] : texts) {
    if (number < 0 || !texts_.try_emplace(number, Text{text, 0}).second || !text_numbers_.emplace(text, number).second)
      throw SnapshotError("the snapshot has duplicate YAML of vehicles or objects");
    size_ += text.size();
  }
}

const std::string& WorldJournal::text(std::int64_t number) const {
  const auto found = texts_.find(number);
  if (found == texts_.end()) throw SnapshotError("the snapshot lists a vehicle or object without its YAML");
  return found->second.text;
}

void WorldJournal::drop(std::size_t place) {
  const auto at = entries_.begin() + static_cast<std::ptrdiff_t>(place);
  size_ -= at->bytes();
  release_text(at->text_number);
  entries_.erase(at);
}

std::optional<std::size_t> WorldJournal::place_of(Entry::Kind kind, const std::string& name) const {
  for (std::size_t i = entries_.size(); i-- > 0;)
    if (entries_[i].kind == kind && entries_[i].name == name) return i;
  return std::nullopt;
}

void WorldJournal::drop_changes_of(const std::string& name, std::size_t first) {
  for (std::size_t i = entries_.size(); i-- > first;) {
    const Entry& entry = entries_[i];
    const bool change = entry.kind == Entry::Kind::device_changed && entry.name.starts_with(name + "/");
    if (change || (entry.kind == Entry::Kind::moved && entry.name == name)) drop(i);
  }
}

void WorldJournal::use_text(std::int64_t number) {
  if (number >= 0) ++texts_.at(number).users;
}

void WorldJournal::release_text(std::int64_t number) {
  if (number < 0) return;
  const auto text = texts_.find(number);
  if (--text->second.users > 0) return;
  size_ -= text->second.text.size();
  text_numbers_.erase(text->second.text);
  texts_.erase(text);
}

/// Stores the YAML source of an entry under the lowest free number.
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

void WorldJournal::note_vehicle(Entry& entry, const VehicleInstance& instance) {
  entry.bus = instance.bus;
  entry.X_W = instance.X_WV;
  if (instance.config->source) return note_source(entry, *instance.config->source);
  for (std::size_t i = 0; i < parts_.config.vehicles.size(); ++i)
    if (parts_.config.vehicles[i].config == instance.config) entry.in_file = static_cast<std::int64_t>(i);
  if (entry.in_file < 0 && gap_.empty()) gap_ = "vehicle '" + instance.name + "' did not come from YAML";
}

void WorldJournal::vehicle_added(const VehicleInstance& instance, const Vehicle& vehicle, bool new_surfaces) {
  if (full_) return;
  Entry added = entry(Entry::Kind::vehicle_added, instance.name);
  note_vehicle(added, instance);
  added.new_surfaces = new_surfaces;
  added.number = vehicle.number();
  added.numbers = parts_.physics.numbers_of(vehicle.group());
  for (const MountedDevice* device : vehicle.devices()) added.devices.push_back(device->number());
  for (const Transducer* transducer : parts_.acoustics->transducers())
    if (transducer != nullptr && transducer->group() == vehicle.group())
      added.transducers.push_back(transducer->number());
  append(std::move(added));
}

void WorldJournal::vehicle_failed(const VehicleInstance& instance, bool new_surfaces) {
  // Surfaces of entities in the world file were added at the start.
  if (full_ || !new_surfaces || !instance.config->source) return;
  Entry surfaces = entry(Entry::Kind::surfaces, instance.name);
  note_vehicle(surfaces, instance);
  append(std::move(surfaces));
}

void WorldJournal::vehicle_removed(const std::string& name) {
  if (full_) return;
  const std::optional<std::size_t> added = place_of(Entry::Kind::vehicle_added, name);
  drop_changes_of(name, added.value_or(0));
  if (!added) return append(entry(Entry::Kind::vehicle_removed, name));
  Entry& removed = entries_[*added];
  if (!removed.new_surfaces || removed.text_number < 0) return drop(*added);
  // The surfaces remain, with their numbers: their order matters.
  size_ -= removed.bytes();
  Entry surfaces;
  surfaces.step = removed.step;
  surfaces.name = name;
  surfaces.text_number = removed.text_number;
  removed = std::move(surfaces);
  size_ += removed.bytes();
}

void WorldJournal::object_added(const ObjectConfig& config, const WorldObject& object, const Pose& X_WE) {
  if (full_) return;
  Entry added = entry(Entry::Kind::object_added, object.name);
  added.X_W = X_WE;
  added.number = object.number;
  added.numbers = parts_.physics.numbers_of(object.group());
  added.in_file = place_in(parts_.config.objects, &config);
  if (added.in_file < 0 && config.source) note_source(added, *config.source);
  if (added.in_file < 0 && !config.source && gap_.empty()) gap_ = "object '" + object.name + "' did not come from YAML";
  append(std::move(added));
}

void WorldJournal::object_removed(const std::string& name) {
  if (full_) return;
  const std::optional<std::size_t> added = place_of(Entry::Kind::object_added, name);
  drop_changes_of(name, added.value_or(0));
  added ? drop(*added) : append(entry(Entry::Kind::object_removed, name));
}

/// Records one entry for each device, with all changed values, because some are valid only in combination.
void WorldJournal::device_changed(const std::string& full_name, const ConfigNode& values) {
  if (full_) return;
  const auto is_set_again = [&](const ConfigNode::Entry& old) {
    return std::any_of(values.entries.begin(), values.entries.end(), [&](const ConfigNode::Entry& value) {
      return old.key == value.key || old.key.starts_with(value.key + ".");
    });
  };
  ConfigNode all = values;
  if (const auto known = place_of(Entry::Kind::device_changed, full_name)) {
    Diagnostics diagnostics;
    ConfigNode before = parse_config_text(entries_[*known].values, "journal", diagnostics);
    std::erase_if(before.entries, is_set_again);
    all.entries.insert(all.entries.begin(), before.entries.begin(), before.entries.end());
    drop(*known);
  }
  Entry changed = entry(Entry::Kind::device_changed, full_name);
  changed.values = to_yaml(all);
  append(std::move(changed));
}

/// Appends the entry at the end, because joints that are created again are the last ones.
void WorldJournal::anchored_moved(const std::string& name, int group) {
  if (full_) return;
  if (const auto known = place_of(Entry::Kind::moved, name)) drop(*known);
  Entry moved = entry(Entry::Kind::moved, name);
  moved.joints = parts_.physics.joint_places(group);
  append(std::move(moved));
}

}  // namespace sim
