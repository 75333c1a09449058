// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/random/random.hpp"

namespace sim {

/// Target of an action: a vehicle or object by name, or `one_of` several.
struct TargetChoice {
  std::vector<std::string> names;

  /// Reads the target.  `key`: key of the name.
  void read(ParamReader& in, const char* key);
  /// Returns the name of the target; draws from `random` when there are several.
  const std::string& choose(Random& random) const;
};

/// Choice of a pose: a given one, one of several positions, or a random one in an area.
struct PlaceChoice {
  std::optional<Vector3d> position_m;
  std::optional<Vector3d> rpy_rad;
  std::vector<Vector3d> places_m;      ///< positions, of which one is drawn at random
  Vector3d area_m = Vector3d::Zero();  ///< size of the box around the position, from which positions are drawn
  bool random_yaw = false;

  void read(ParamReader& in);
  /// Draws a pose in the world frame.  `X_W_unless`: default for the position or orientation that is not given.
  Pose choose(const Pose& X_W_unless, Random& random) const;
};

}  // namespace sim
