// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "autonomy/known_map/path_search.hpp"
#include "autonomy/mapping/lidar_odometry.hpp"
#include "autonomy/mapping/occupancy_map.hpp"
#include "autonomy/mapping/path.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/occupancy_grid_t.hpp"
#include "shoal/planar_lidar_t.hpp"

namespace autonomy {

/// Plans paths to goals, one after another, in the map that another program publishes, and around what the lidar sees
/// that is not in it: for `memory_s` or longer, as long as it was seen.  It plans again when the map changes, something
/// is in the path, or the vehicle has left the path.  When there is none, the vehicle is to look around.  While the
/// estimate is uncertain it plans nothing, and forgets what the lidar saw shortly before, when it may have been
/// elsewhere already.  A pure function of the messages and ticks in their order.  Its copy is its whole state.
class Planner {
 public:
  struct Params {
    PathCosts costs;
    double cell_m = 0.1;  ///< side of its own cells; a multiple of those of the map is used
    LidarMount lidar;
    double memory_s = 600;
    double lost_std_m = 1;          ///< standard deviation of an estimate that is uncertain
    std::vector<Vector2d> goals_W;  ///< until others are received
    bool loop = false;              ///< from the last goal to the first
    double reached_m = 0.5;         ///< acceptance radius of a goal
    double stray_m = 1;             ///< distance from the path at which it plans again
    double retry_s = 5;             ///< after which it plans again when there was no path
    double give_up_s = 120;         ///< a goal is given up after this time without a path
  };
  /// Result of a step: what to publish and to report.
  struct Decision {
    std::optional<shoal::waypoints_command_t>
        path;          ///< the new one; one point: it is to look around there; none: to stand
    std::string line;  ///< empty: nothing to report
  };

  explicit Planner(const Params& params) : params_(params), goals_W_(params.goals_W), loop_(params.loop) {}

  /// Throws as frame_of().
  void receive(const shoal::occupancy_grid_t& map);
  void receive(const shoal::planar_lidar_t& scan);
  /// Throws shoal::MessageError when its position is not within 1e7 m; one that is not finite is uncertain.
  void receive(const shoal::estimate_t& estimate);
  /// Replaces the goals.  Throws as path_of().
  void receive(const shoal::waypoints_command_t& goals);
  Decision step(std::int64_t utime);

  bool has_map() const { return map_ != nullptr; }
  int reached() const { return reached_; }
  int given_up() const { return given_up_; }
  int plans() const { return plans_; }
  /// Scans that had the time of an estimate: others are not used.
  int used_scans() const { return used_scans_; }
  const std::vector<Vector2d>& path_W() const { return path_W_; }

 private:
  /// Map in the cells of the planner: -1 unknown, 0 free, 1 occupied.
  struct CoarseMap {
    GridFrame frame;
    std::vector<std::int8_t> cells;
  };
  void see(const Pose2& pose);
  PlanGrid grid() const;
  /// Returns the first point of the rest of the path that is too near to an obstacle.
  std::optional<Vector2d> blocked_at(const PlanGrid& grid, const Vector2d& p_W) const;
  Decision plan(std::int64_t utime, const Vector2d& p_W, const PlanGrid& grid, std::string line);
  /// `line` is reported with it.
  Decision next_goal(std::int64_t utime, std::string line);
  Decision stop(std::int64_t utime, const std::vector<Vector2d>& at_W, std::string line);

  Params params_;
  std::shared_ptr<const CoarseMap> map_;
  std::optional<OccupancyMap> seen_;
  std::deque<OccupancyMap> seen_before_;     ///< some scans
  std::int64_t first_seen_utime_ = 0;        ///< from which it counts its time
  std::deque<shoal::planar_lidar_t> scans_;  ///< of which no estimate has come
  std::optional<shoal::estimate_t> estimate_;
  std::vector<Vector2d> goals_W_;
  bool loop_;
  std::size_t current_ = 0;
  std::vector<Vector2d> path_W_;
  bool is_due_ = true;  ///< to plan again
  std::optional<std::int64_t> no_path_since_;
  std::string why_none_;
  std::int64_t tried_utime_ = 0;
  int reached_ = 0, given_up_ = 0, plans_ = 0, used_scans_ = 0;
};

}  // namespace autonomy
