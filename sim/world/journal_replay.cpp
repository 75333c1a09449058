// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world/journal_replay.hpp"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sim/config/diagnostics.hpp"
#include "sim/vehicle/entities.hpp"
#include "sim/world/world_builder.hpp"
#include "sim/world/world_journal.hpp"
#include "sim/world/world_parts.hpp"
#include "sim/world_file/load_world.hpp"
#include "sim/world_file/vehicle_loader.hpp"

namespace sim {

void JournalReplay::replay(std::span<const std::byte> bytes, std::int64_t last_step) {
  journal_.start_again({});  // even when it cannot be read: the world is then as in its file
  // Restore texts and entries.
  WorldJournal::Texts texts;
  std::vector<Entry> entries;
  std::vector<int> free;
  std::int64_t devices = 0;
  StateArchive archive = StateArchive::restorer(bytes);
  archive(texts, entries, free, devices);
  archive.end();
  journal_.start_again(texts);
  // Apply the entries in order.
  std::int64_t earliest = 0;
  try {
    for (Entry& entry : entries) {
      if (entry.step < earliest || entry.step > last_step)
        throw SnapshotError("the snapshot lists changes in an invalid order");
      earliest = entry.step;
      apply(entry);
      journal_.append(std::move(entry));
    }
    parts_.devices.set_free(std::move(free), devices);
  } catch (const ConfigError& error) {
    throw SnapshotError("additions before the snapshot cannot be replayed: " + error.lines().front());
  } catch (const WorldError& error) {
    throw SnapshotError(std::string("changes before the snapshot cannot be replayed: ") + error.what());
  } catch (const std::out_of_range& error) {
    throw SnapshotError(std::string("an input of the world before the snapshot has an invalid value: numbers: ") +
                        error.what());
  }
}

namespace {

void check_pose(const Pose& X_W) {
  const Matrix3d R = X_W.linear();
  const bool good = X_W.matrix().allFinite() && X_W.translation().cwiseAbs().maxCoeff() < 1e9 &&
                    (R.transpose() * R - Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-3 && R.determinant() > 0;
  if (!good)
    throw SnapshotError(
        "the snapshot has an invalid value: the pose at which something was added or to which it was moved");
}

}  // namespace

void JournalReplay::apply(const Entry& entry) {
  // Each change is made at its own step: what is added looks at the time, and the water of that time, as it did in
  // the run.
  parts_.clock.step_number = entry.step;
  parts_.medium.advance_to(parts_.clock.now());
  check_pose(entry.X_W);
  switch (entry.kind) {
    case Entry::Kind::vehicle_added:
      return apply_vehicle(entry);
    case Entry::Kind::surfaces:
      return parts_.surfaces.add(*vehicle_config(entry));
    case Entry::Kind::vehicle_removed:
      return builder_.dismantle(parts_.entities.vehicle_named(entry.name));
    case Entry::Kind::object_added:
      return apply_object(entry);
    case Entry::Kind::object_removed:
      return builder_.dismantle(parts_.entities.object_named(entry.name));
    case Entry::Kind::device_changed:
      return apply_change(entry);
    case Entry::Kind::moved:
      return apply_move(entry);
  }
  throw SnapshotError("the snapshot lists a change of an unknown kind");
}

void JournalReplay::apply_vehicle(const Entry& entry) {
  if (entry.number < 0 || entry.number > 100'000'000)
    throw SnapshotError("the snapshot has a vehicle without a number");
  if (parts_.entities.find_vehicle(entry.name) != nullptr) throw SnapshotError("the snapshot has a vehicle twice");
  VehicleInstance instance;
  instance.name = entry.name;
  instance.X_WV = entry.X_W;
  instance.bus = entry.bus;
  instance.config = vehicle_config(entry);
  parts_.surfaces.add(*instance.config);
  parts_.entities.prescribe_vehicle_number(static_cast<int>(entry.number));
  parts_.physics.prescribe(entry.numbers);
  parts_.devices.prescribe(entry.devices);
  parts_.acoustics->prescribe(entry.transducers);
  builder_.build_vehicle(instance);
  if (!parts_.physics.as_prescribed() || !parts_.acoustics->as_prescribed() || !parts_.devices.as_prescribed())
    throw std::out_of_range("there are more numbers than entities");
}

void JournalReplay::apply_object(const Entry& entry) {
  if (parts_.entities.find_object(entry.name) != nullptr) throw SnapshotError("the snapshot has an object twice");
  // The numbers must be those of the run: they are part of the state, and of its hashes.
  parts_.entities.prescribe_object_number(entry.number);
  parts_.physics.prescribe(entry.numbers);
  if (entry.in_file >= 0) {
    if (entry.in_file >= static_cast<std::int64_t>(parts_.config.objects.size()))
      throw SnapshotError("the snapshot has an object that is not in the world file");
    builder_.place_object(parts_.config.objects[static_cast<std::size_t>(entry.in_file)], entry.name, entry.X_W);
  } else {
    builder_.place_object(object_config(entry), entry.name, entry.X_W);
  }
  if (!parts_.physics.as_prescribed()) throw std::out_of_range("there are more numbers than entities");
}

void JournalReplay::apply_change(const Entry& entry) {
  Diagnostics diagnostics(parts_.config.files);
  const ConfigNode values = parse_config_text(entry.values, "snapshot", diagnostics);
  diagnostics.throw_if_any();
  builder_.change_device(entry.name, values, diagnostics);
  diagnostics.throw_if_any();
}

void JournalReplay::apply_move(const Entry& entry) {
  for (const JointPlace& joint : entry.joints) {
    check_pose(joint.X_WV);
    check_pose(joint.X_WC);
  }
  const WorldObject* object = parts_.entities.find_object(entry.name);
  const Mechanism& moved = object ? static_cast<const Mechanism&>(*object) : parts_.entities.vehicle_named(entry.name);
  parts_.physics.make_joints_again(moved.group(), entry.joints);
}

const ConfigNode& JournalReplay::parsed(std::int64_t text_number) {
  const std::string& text = journal_.text(text_number);
  const auto [found, fresh] = parsed_.try_emplace(text_number);
  if (fresh) {
    Diagnostics diagnostics(parts_.config.files);
    found->second = parse_config_text(text, "snapshot", diagnostics);
    diagnostics.throw_if_any();
  }
  return found->second;
}

std::shared_ptr<const VehicleConfig> JournalReplay::vehicle_config(const Entry& entry) {
  if (entry.text_number < 0) {
    if (entry.in_file < 0 || entry.in_file >= static_cast<std::int64_t>(parts_.config.vehicles.size()))
      throw SnapshotError("the snapshot has a vehicle that is not in the world file");
    return parts_.config.vehicles[static_cast<std::size_t>(entry.in_file)].config;
  }
  const auto [found, fresh] = vehicles_.try_emplace(entry.text_number);
  if (fresh) {
    Diagnostics diagnostics(parts_.config.files);
    found->second =
        VehicleLoader(parts_.config, diagnostics).read(parsed(entry.text_number), "vehicle '" + entry.name + "'");
    diagnostics.throw_if_any();
  }
  return found->second;
}

ObjectConfig JournalReplay::object_config(const Entry& entry) {
  Diagnostics diagnostics(parts_.config.files);
  ParamReader in(parsed(entry.text_number), "object '" + entry.name + "'", diagnostics);
  declare_surfaces(in, parts_.config);
  ObjectConfig config;
  config.read(in);
  in.finish();
  diagnostics.throw_if_any();
  return config;
}

}  // namespace sim
