// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "autonomy/behaviors/obstacle_avoidance.hpp"
#include "autonomy/behaviors/waypoint_follower.hpp"
#include "autonomy/mapping/path.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/planar_lidar_t.hpp"

namespace autonomy {

/// Drives rounds by the pose that another program estimates: along waypoints with a pause at each, and a longer one at
/// the first, where it charges.  It drives around what its lidar sees.  While the estimate is uncertain it turns on the
/// spot, so that the other program sees all around, and then drives on, since another place may be easier to know, in
/// turns.  Without waypoints it drives along the paths that a planner sends, to the end of each, and looks around at
/// that of one point.  A pure function of the messages and ticks in their order.
class Patrol {
 public:
  struct Params {
    std::vector<Vector2d> waypoints_W;  ///< the first is the place where it charges; none: paths
    double speed_mps = 0.6;
    double pause_s = 5;         ///< at each waypoint
    double charge_s = 480;      ///< at the first waypoint
    double reached_m = 0.6;     ///< acceptance radius of a waypoint
    double give_up_s = 60;      ///< a waypoint is skipped after this time without progress
    double lost_std_m = 1;      ///< standard deviation of the estimate above which it turns on the spot
    double search_radps = 0.4;  ///< turn rate of this, and of looking around
    double search_drive_s = 8;  ///< after each full turn it drives for this long
    double ahead_m = 1;         ///< it steers for the point of a path that is this far ahead
    double period_s = 1;        ///< between ticks: the longer, the smaller its turns
  };

  explicit Patrol(const Params& params);

  void receive(const shoal::odometry_t& odometry);
  void receive(const shoal::planar_lidar_t& scan);
  void receive(const shoal::estimate_t& estimate);
  /// Throws shoal::MessageError as path_of().
  void receive(const shoal::waypoints_command_t& path) { path_W_ = path_of(path); }
  /// Decides at the tick `utime`, in simulated time.
  Twist step(std::int64_t utime);

  /// Number of completed rounds.
  int rounds() const { return rounds_; }
  /// std::nullopt when it drives along paths.
  const std::optional<WaypointFollower>& follower() const { return follower_; }

 private:
  /// Returns the estimate moved by the odometry since its time.
  Pose2 present_pose() const;
  Twist steer(const Vector2d& goal_B);
  Twist along_path();
  Twist to_waypoint(std::int64_t utime);
  /// Phase of the patrol while the estimate is uncertain.
  Twist seek_place(std::int64_t utime);

  Params params_;
  std::optional<WaypointFollower> follower_;
  ObstacleAvoidance avoidance_;
  std::deque<std::pair<std::int64_t, Pose2>> odometry_;  ///< of the last seconds, by time
  std::optional<shoal::estimate_t> estimate_;
  Scan scan_;
  std::int64_t scan_utime_ = 0;
  std::int64_t newest_utime_ = 0, newest_tick_ = 0;  ///< of the last odometry, and the tick when it was first there
  std::vector<Vector2d> path_W_;
  int passed_ = 0;  ///< waypoints reached or given up
  int reached_ = 0;
  int rounds_ = 0;
  std::int64_t rests_until_ = 0;
  std::optional<std::int64_t> lost_since_;
};

}  // namespace autonomy
