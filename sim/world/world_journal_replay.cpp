// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <set>
#include <stdexcept>

#include "sim/acoustics/channel.hpp"
#include "sim/config/diagnostics.hpp"
#include "sim/world/world.hpp"
#include "sim/world/world_journal.hpp"
#include "sim/world_file/load_world.hpp"
#include "sim/world_file/vehicle_loader.hpp"

// What the journal tells, done again.

namespace sim {

void WorldJournal::replay(std::span<const std::byte> bytes, std::int64_t last_step) {
  forget();
  gap_.clear();
  full_ = false;
  std::vector<std::pair<std::int64_t, std::string>> texts;
  std::vector<Entry> entries;
  std::vector<int> free;
  std::int64_t devices = 0;
  StateArchive archive = StateArchive::restorer(bytes);
  archive(texts, entries, free, devices);
  archive.end();
  for (const auto& [number, text] : texts) {
    if (number < 0 || !texts_.try_emplace(number, Text{text, 0}).second || !text_numbers_.emplace(text, number).second)
      throw SnapshotError("the snapshot has the YAML of vehicles or objects twice");
    size_ += text.size();
  }
  std::int64_t earliest = 0;
  try {
    for (Entry& entry : entries) {
      if (entry.step < earliest || entry.step > last_step)
        throw SnapshotError("the snapshot tells of changes in an order that cannot be");
      earliest = entry.step;
      apply(entry);
      append(std::move(entry));
    }
    set_free_devices(std::move(free), devices);
  } catch (const ConfigError& error) {
    throw SnapshotError("what came to the world before the snapshot cannot come again: " + error.lines().front());
  } catch (const WorldError& error) {
    throw SnapshotError(std::string("what happened to the world before the snapshot cannot happen again: ") +
                        error.what());
  } catch (const std::out_of_range& error) {
    throw SnapshotError(std::string("what came to the world before the snapshot has numbers that cannot be: ") +
                        error.what());
  }
  parsed_.clear();
  vehicles_.clear();
}

namespace {

void check_pose(const Pose& X_W) {
  const Matrix3d R = X_W.linear();
  const bool good = X_W.matrix().allFinite() && X_W.translation().cwiseAbs().maxCoeff() < 1e9 &&
                    (R.transpose() * R - Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-3 && R.determinant() > 0;
  if (!good) throw SnapshotError("the snapshot has something come to, or moved to, a pose that cannot be");
}

}  // namespace

void WorldJournal::apply(const Entry& entry) {
  world_.step_number_ = entry.step;
  world_.medium_.advance_to(world_.now());
  check_pose(entry.X_W);
  switch (entry.kind) {
    case Kind::vehicle_came:
      return apply_vehicle(entry);
    case Kind::surfaces:
      return world_.bring_surfaces(*vehicle_config(entry));
    case Kind::vehicle_went:
      return world_.take_apart(world_.vehicle_named(entry.name));
    case Kind::object_came:
      return apply_object(entry);
    case Kind::object_went:
      return world_.take_apart(world_.object_named(entry.name));
    case Kind::device_changed: {
      Diagnostics diagnostics(world_.config().files);
      const ConfigNode values = parse_config_text(entry.values, "snapshot", diagnostics);
      diagnostics.throw_if_any();
      world_.apply_change(entry.name, values, diagnostics);
      diagnostics.throw_if_any();
      return;
    }
    case Kind::moved:
      return apply_move(entry);
  }
  throw SnapshotError("the snapshot tells of a change of a kind that is none");
}

void WorldJournal::apply_vehicle(const Entry& entry) {
  if (entry.number < 0 || entry.number > 100'000'000) throw SnapshotError("the snapshot has a vehicle of no number");
  if (world_.find_vehicle(entry.name) != nullptr) throw SnapshotError("the snapshot has a vehicle twice");
  VehicleInstance instance;
  instance.name = entry.name;
  instance.X_WV = entry.X_W;
  instance.bus = entry.bus;
  instance.config = vehicle_config(entry);
  world_.bring_surfaces(*instance.config);
  world_.next_vehicle_number_ = static_cast<int>(entry.number);
  world_.physics_->prescribe(entry.numbers);
  prescribe_devices(entry);
  world_.build_vehicle(instance);
  check_prescribed();
}

void WorldJournal::prescribe_devices(const Entry& entry) {
  constexpr int most = 10'000'000;
  std::vector<int>& free = world_.free_numbers_;
  free.assign(entry.devices.rbegin(), entry.devices.rend());
  auto& devices = world_.devices_;
  for (const int number : free) {
    if (number < 0 || number >= most) throw std::out_of_range("a device");
    if (static_cast<std::size_t>(number) >= devices.size()) devices.resize(static_cast<std::size_t>(number) + 1);
    if (devices[static_cast<std::size_t>(number)]) throw std::out_of_range("a device");
  }
  if (std::set<int>(free.begin(), free.end()).size() != free.size()) throw std::out_of_range("a device");
  if (!world_.acoustics_->prescribe(entry.transducers)) throw std::out_of_range("a transducer");
}

void WorldJournal::check_prescribed() const {
  const bool all =
      world_.physics_->as_prescribed() && world_.acoustics_->as_prescribed() && world_.free_numbers_.empty();
  if (!all) throw std::out_of_range("there are more numbers than things");
}

void WorldJournal::set_free_devices(std::vector<int> free, std::int64_t devices) {
  const auto there = static_cast<std::size_t>(std::count_if(world_.devices_.begin(), world_.devices_.end(),
                                                            [](const auto& device) { return device != nullptr; }));
  const auto size = static_cast<std::size_t>(devices);
  std::vector<int> sorted = free;
  std::sort(sorted.begin(), sorted.end());
  const auto taken = [&](int number) {
    return number < 0 || number >= devices ||
           (static_cast<std::size_t>(number) < world_.devices_.size() &&
            world_.devices_[static_cast<std::size_t>(number)] != nullptr);
  };
  if (size < world_.devices_.size() || there + free.size() != size ||
      std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end() || std::any_of(free.begin(), free.end(), taken))
    throw SnapshotError("the snapshot has numbers of devices that cannot be");
  world_.devices_.resize(size);
  world_.free_numbers_ = std::move(free);
}

void WorldJournal::apply_object(const Entry& entry) {
  if (world_.find_object(entry.name) != nullptr) throw SnapshotError("the snapshot has an object twice");
  world_.next_object_number_ = entry.number;
  world_.physics_->prescribe(entry.numbers);
  if (entry.in_file >= 0) {
    if (entry.in_file >= static_cast<std::int64_t>(world_.config().objects.size()))
      throw SnapshotError("the snapshot has an object that the world file has not");
    world_.place_object(world_.config().objects[static_cast<std::size_t>(entry.in_file)], entry.name, entry.X_W);
  } else {
    world_.place_object(object_config(entry), entry.name, entry.X_W);
  }
  if (!world_.physics_->as_prescribed()) throw std::out_of_range("there are more numbers than things");
}

void WorldJournal::apply_move(const Entry& entry) {
  for (const JointPlace& joint : entry.joints) {
    check_pose(joint.X_WV);
    check_pose(joint.X_WC);
  }
  world_.physics_->make_joints_again(world_.vehicle_named(entry.name).group(), entry.joints);
}

const ConfigNode& WorldJournal::parsed(std::int64_t text_number) {
  const auto text = texts_.find(text_number);
  if (text == texts_.end()) throw SnapshotError("the snapshot tells of a vehicle or object without its YAML");
  const auto [found, fresh] = parsed_.try_emplace(text_number);
  if (fresh) {
    Diagnostics diagnostics(world_.config().files);
    found->second = parse_config_text(text->second.text, "snapshot", diagnostics);
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
    Diagnostics diagnostics(world_.config().files);
    found->second =
        VehicleLoader(world_.config(), diagnostics).read(parsed(entry.text_number), "vehicle '" + entry.name + "'");
    diagnostics.throw_if_any();
  }
  return found->second;
}

ObjectConfig WorldJournal::object_config(const Entry& entry) {
  Diagnostics diagnostics(world_.config().files);
  ParamReader in(parsed(entry.text_number), "object '" + entry.name + "'", diagnostics);
  declare_surfaces(in, world_.config());
  ObjectConfig config;
  config.read(in);
  in.finish();
  diagnostics.throw_if_any();
  return config;
}

}  // namespace sim
