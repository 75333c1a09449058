// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

/// Layout of the instances of an entry with `count`, relative to the pose of the entry.
struct PlacementConfig {
  /// Arrangement of the instances.
  enum class Pattern { grid, line, circle, random };

  Pattern pattern = Pattern::grid;
  double spacing_m = 2.0;      ///< grid, line
  int columns = 0;             ///< grid: instances along x; 0: as square as possible
  double radius_m = 10.0;      ///< circle
  Vector3d area_m{10, 10, 0};  ///< random: size of the box that positions are drawn from
  double jitter_m = 0;         ///< maximum random offset in x and y, uniformly distributed
  bool random_yaw = false;     ///< yaw angles are drawn from the full circle

  void read(ParamReader& in);
};

/// Returns the poses of `count` instances, reproducible from seed and name.  Grid and line are centered on the pose
/// X_WE of the entry.
std::vector<Pose> place_instances(const PlacementConfig& config, int count, const Pose& X_WE, std::uint64_t seed,
                                  const std::string& name);

}  // namespace sim
