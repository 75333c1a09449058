// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "motion/analysis/motion_stage.hpp"

namespace motion {

/// Tilt beyond which a vehicle has fallen.
constexpr double fallen_rad = std::numbers::pi / 4;

/// Returns the angle between the z axis of a vehicle and the vertical, rad.
double tilt_rad(const sim::Vehicle& vehicle);

/// Returns whether the first body of a vehicle touches anything but the vehicle.  The contacts of its group must be
/// watched.
bool first_body_touches(const sim::World& world, const sim::Vehicle& vehicle);

/// How the joints of a vehicle follow a motion, and how it stands.
class MotionTracking {
 public:
  /// Adds the present step.
  void add(MotionStage& stage);
  /// Returns a table: for each servo the maximum and the rms difference of set point and joint, deg.  The joints of
  /// the motion come first; of the others those that are never off by 0.0005 deg are one line.
  std::string text(const sim::JointMotion& motion) const;
  /// Returns whether the vehicle has fallen meanwhile.
  bool has_fallen() const;
  double greatest_tilt_rad() const { return tilt_rad_; }
  double greatest_error_rad() const;

 private:
  struct Servo {
    std::string name, alias;
    double greatest = 0, sum2 = 0;
  };
  std::vector<Servo> servos_;
  std::int64_t steps_ = 0;
  double tilt_rad_ = 0;
};

}  // namespace motion
