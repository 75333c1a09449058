// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace motion {

/// Range and speed of a joint of a leg, rad and rad/s.
struct LegJointLimits {
  double low = -3, high = 3, max_velocity = 1e9;
};

/// Positions of the joints of a leg, rad.
struct LegPosture {
  double swing = 0, flap = 0, knee = 0;
  bool reached = true;  ///< false: the foot cannot be at the desired point
};

/// Leg with a hip of two crossing axes and a knee: it swings about y, flaps about x, and the knee turns about y.
struct Leg {
  std::string name;  ///< such as `lf`; its servos are `lf_swing`, `lf_flap` and `lf_knee`
  // Positions in the vehicle frame, with all joints at zero.
  sim::Vector3d hip = sim::Vector3d::Zero(), knee = sim::Vector3d::Zero(), foot = sim::Vector3d::Zero();
  double foot_radius_m = 0;
  /// Directions of the axes: 1 along +y (swing, knee) or +x (flap), -1 against it.
  double swing_sign = 1, flap_sign = 1, knee_sign = 1;
  LegJointLimits swing_limits, flap_limits, knee_limits;

  /// Returns the center of the foot in the vehicle frame.
  sim::Vector3d foot_at(const LegPosture& posture) const;
  /// Returns the posture with the center of the foot at a point in the vehicle frame: the knee turned in its positive
  /// direction, the leg below the hip.  A point out of reach: the foot is as near as possible on the line from the hip.
  LegPosture posture_at(const sim::Vector3d& foot_V) const;
};

/// Returns the legs `lf`, `rf`, `lh` and `rh` of a vehicle.  Their servos are named `lf_swing`, `lf_flap`, `lf_knee`;
/// the foot is the sphere `ball` of the body that the knee moves.  Throws ConfigError with all that is missing.
std::vector<Leg> legs_of(const sim::VehicleConfig& vehicle);

}  // namespace motion
