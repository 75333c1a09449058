// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "shoal/estimate_t.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "tools/autonomy/behaviours/obstacle_avoidance.hpp"
#include "tools/autonomy/behaviours/waypoint_follower.hpp"

namespace autonomy {

/// Drives rounds by the pose that another program estimates: along waypoints with a pause at each, and a longer one at
/// the first, where it charges.  It drives around what its lidar sees.  While the estimate is uncertain it turns on the
/// spot, so that the other program sees all around, and then drives on, since another place may be easier to know, in
/// turns.  A pure function of the messages and ticks in their order.
class Patrol {
 public:
  struct Params {
    std::vector<Vector2d> waypoints_W;  ///< the first is the place where it charges
    double speed_mps = 0.6;
    double pause_s = 5;         ///< at each waypoint
    double charge_s = 480;      ///< at the first waypoint
    double reached_m = 0.6;     ///< acceptance radius of a waypoint
    double give_up_s = 60;      ///< a waypoint is skipped after this time without progress
    double lost_std_m = 1;      ///< standard deviation of the estimate from which on it turns on the spot
    double search_radps = 0.4;  ///< turn rate of this
    double search_drive_s = 8;  ///< after each full turn it drives for this long
    double period_s = 1;        ///< between ticks: the longer, the smaller its turns
  };

  /// Throws std::invalid_argument without waypoints.
  explicit Patrol(const Params& params);

  void receive(const shoal::odometry_t& odometry);
  void receive(const shoal::planar_lidar_t& scan);
  void receive(const shoal::estimate_t& estimate);
  /// Decides at the tick `utime`, in simulated time.
  Twist step(std::int64_t utime);

  /// Number of completed rounds.
  int rounds() const { return rounds_; }
  const WaypointFollower& follower() const { return follower_; }

 private:
  /// Returns the estimate moved by the odometry since its time.
  Pose2 present_pose() const;
  Twist steer(const Vector2d& goal_B);
  /// What it does while the estimate is uncertain.
  Twist seek_place(std::int64_t utime);

  Params params_;
  WaypointFollower follower_;
  ObstacleAvoidance avoidance_;
  std::deque<std::pair<std::int64_t, Pose2>> odometry_;  ///< of the last seconds, by time
  std::optional<shoal::estimate_t> estimate_;
  Scan scan_;
  std::int64_t scan_utime_ = 0;
  std::int64_t newest_utime_ = 0, newest_tick_ = 0;  ///< of the last odometry, and the tick when it was first there
  int passed_ = 0;                                   ///< waypoints reached or given up
  int reached_ = 0;
  int rounds_ = 0;
  std::int64_t rests_until_ = 0;
  std::optional<std::int64_t> lost_since_;
};

}  // namespace autonomy
