// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/random/random.hpp"

namespace sim {

/// Where something is put: at a pose, at one of several places, or somewhere in an area.
struct PlaceChoice {
  std::optional<Vector3d> position_m;
  std::optional<Vector3d> rpy_rad;
  std::vector<Vector3d> places_m;      ///< one of them, at random
  Vector3d area_m = Vector3d::Zero();  ///< size of the box around the position that places are drawn from
  bool random_yaw = false;

  void read(ParamReader& in);
  /// `X_W_unless`: default of the parts that are not given.
  Pose choose(const Pose& X_W_unless, Random& random) const;
};

}  // namespace sim
