// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "autonomy/behaviors/scan.hpp"
#include "autonomy/filters/pose2.hpp"

namespace autonomy {

/// Steers towards a goal and around obstacles in the lidar scan: takes the free direction nearest to the goal, and
/// turns on the spot when none is free.
class ObstacleAvoidance {
 public:
  struct Params {
    double speed_mps = 0.8;
    double max_turn_radps = 1.0;
    double half_width_m = 0.55;  ///< of the lane the rover needs: its corners are 0.39 m from its middle
    double stop_m = 0.55;        ///< stops when the lane is blocked within this distance
    double slow_m = 2.0;         ///< full speed when the lane is free up to this distance
    double look_ahead_m = 3.0;   ///< a direction is free when its lane is free up to this distance or the goal
  };

  ObstacleAvoidance() : ObstacleAvoidance(Params()) {}
  explicit ObstacleAvoidance(const Params& params) : params_(params) {}

  Twist steer(const Vector2d& goal_B, const Scan& scan);
  /// Returns the free length of the lane in a direction.
  double free_distance_m(const Scan& scan, double direction_rad) const;

 private:
  /// Finds the free direction with the lowest cost; false when there is none.
  bool choose_direction(const Vector2d& goal_B, const Scan& scan, double& direction_rad) const;
  Twist turn_out(const Scan& scan);

  Params params_;
  double last_direction_rad_ = 0;
  int turning_out_ = 0;  ///< turn on the spot: +1 left, -1 right, 0 none
};

}  // namespace autonomy
