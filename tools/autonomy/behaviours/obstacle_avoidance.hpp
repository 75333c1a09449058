// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/autonomy/behaviours/scan.hpp"
#include "tools/autonomy/filters/pose2.hpp"

namespace autonomy {

/// Steers towards a goal and around what the lidar sees: takes the free direction nearest to the goal, and
/// turns on the spot where none is free.
class ObstacleAvoidance {
 public:
  struct Params {
    double speed_mps = 0.8;
    double max_turn_radps = 1.0;
    double half_width_m = 0.55;  ///< of the lane the rover needs: its corners are 0.39 m from its middle
    double stop_m = 0.55;        ///< no way ahead when the lane is blocked nearer than this
    double slow_m = 2.0;         ///< full speed when the lane is free so far
    double look_ahead_m = 3.0;   ///< a direction is free when its lane is, so far or up to the goal
  };

  ObstacleAvoidance() : ObstacleAvoidance(Params()) {}
  explicit ObstacleAvoidance(const Params& params) : params_(params) {}

  Twist steer(const Vector2d& goal_B, const Scan& scan);
  /// How far the lane in a direction is free.
  double free_distance_m(const Scan& scan, double direction_rad) const;

 private:
  /// The free direction that costs least; false when there is none.
  bool choose_direction(const Vector2d& goal_B, const Scan& scan, double& direction_rad) const;
  Twist turn_out(const Scan& scan);

  Params params_;
  double last_direction_rad_ = 0;
  int turning_out_ = 0;  ///< on the spot: +1 left, -1 right, 0 not
};

}  // namespace autonomy
