// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "autonomy/filters/pose2.hpp"

namespace autonomy {

/// Move in the body frame at its start.
struct Increment {
  double forward_m = 0;
  double left_m = 0;
  double turn_rad = 0;
};

/// Converts the accumulated odometry to increments, and to its own pose frame.
class Odometer {
 public:
  explicit Odometer(const Pose2& start) : start_(start) {}

  /// `p_0`, `theta_rad`: pose relative to the start.  Returns the move since the last call.
  Increment update(const Vector2d& p_0, double theta_rad) {
    const Vector2d moved = turned(p_0 - p_0_, -theta_rad_);
    const Increment increment{moved.x(), moved.y(), theta_rad - theta_rad_};
    p_0_ = p_0;
    theta_rad_ = theta_rad;
    return increment;
  }
  /// Returns start pose plus odometry: the pose of the rover by dead reckoning only.
  Pose2 pose() const { return {start_.p_W + turned(p_0_, start_.yaw_rad), start_.yaw_rad + theta_rad_}; }

 private:
  Pose2 start_;
  Vector2d p_0_ = Vector2d::Zero();
  double theta_rad_ = 0;
};

}  // namespace autonomy
