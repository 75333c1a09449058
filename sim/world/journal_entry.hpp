// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// Difference between a world and its configuration.
struct JournalEntry {
  enum class Kind {
    vehicle_added,
    vehicle_removed,  ///< one of the world file
    object_added,
    object_removed,  ///< one of the world file
    device_changed,
    moved,    ///< a vehicle that is joined to the world was moved
    surfaces  ///< of a vehicle that could not be added, or was removed again
  };

  Kind kind = Kind::surfaces;
  std::int64_t step = 0;
  std::string name;
  std::string values;         ///< of a device, YAML
  std::int64_t in_file = -1;  ///< index in the list of the world file; -1: not from the world file
  std::int64_t text_number = -1;
  std::string bus;
  Pose X_W = Pose::Identity();
  bool new_surfaces = false;  ///< whether a vehicle added surfaces
  std::int64_t number = 0;    ///< of the vehicle or object
  GroupNumbers numbers;
  std::vector<int> devices, transducers;  ///< numbers of the devices and transducers
  std::vector<JointPlace> joints;         ///< joints of a vehicle that was moved

  void visit_state(StateArchive& archive);
  /// Returns the approximate size.
  std::size_t bytes() const;
};

}  // namespace sim
