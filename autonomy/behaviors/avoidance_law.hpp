// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "autonomy/behaviors/helm_behavior.hpp"
#include "autonomy/behaviors/obstacle_tracks.hpp"

namespace autonomy {

/// Properties of the vehicle that an avoidance law needs.
struct AvoidanceParams {
  double keep_m = 3;         ///< distance between the middle of the vehicle and the edge of an obstacle
  double horizon_s = 15;     ///< look-ahead time
  double turn_radps = 0.3;   ///< rate of turn
  double speed_time_s = 3;   ///< time constant of the speed
  double speed_min_mps = 0;  ///< slowest speed at which it can be steered
};

/// Turns the desired course so that the vehicle keeps clear of obstacles.
class AvoidanceLaw {
 public:
  virtual ~AvoidanceLaw() = default;
  /// `own.yaw_rad` must be known.  `drift_W`: motion of the water.
  virtual Course steer(const Motion& own, const Vector2d& drift_W, const Course& desired,
                       std::span<const Obstacle> obstacles) = 0;
  virtual std::unique_ptr<AvoidanceLaw> clone() const = 0;
};

/// Names of the laws, for `avoid`.
std::vector<std::string> avoidance_names();
/// Throws std::invalid_argument for a name that is not among them.
std::unique_ptr<AvoidanceLaw> make_avoidance(const std::string& name, const AvoidanceParams& params);

}  // namespace autonomy
