// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

/// Where the instances of an entry with `count` stand, relative to the entry's own pose.
struct PlacementConfig {
  enum class Pattern { grid, line, circle, random };

  Pattern pattern = Pattern::grid;
  double spacing_m = 2.0;      ///< grid, line
  int columns = 0;             ///< grid: along x; 0: as square as possible
  double radius_m = 10.0;      ///< circle
  Vector3d area_m{10, 10, 0};  ///< random: size of the box that places are drawn from
  double jitter_m = 0;         ///< uniform in x and y, within +- this
  bool random_yaw = false;

  void read(ParamReader& in);
};

/// The poses of `count` instances.  Equal for equal seed and name.  Grid and line are centred on the entry's pose.
std::vector<Pose> place_instances(const PlacementConfig& config, int count, const Pose& X_WE, std::uint64_t seed,
                                  const std::string& name);

}  // namespace sim
