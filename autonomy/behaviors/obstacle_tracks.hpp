// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "autonomy/behaviors/helm_behavior.hpp"
#include "autonomy/behaviors/scan.hpp"

namespace autonomy {

/// Disc that moves with a constant velocity.
struct Obstacle {
  Vector2d p_W = Vector2d::Zero();
  Vector2d v_W = Vector2d::Zero();
  double radius_m = 0;
};

/// Obstacles in the scans of a lidar or a forward sonar.  Neighboring echoes less than `gap_m` apart are one group; a
/// long group, such as a wall, is divided into pieces of at most `extent_m`.  The circle about the ends of a group is
/// an obstacle.  A group that stands alone is tracked by an alpha-beta filter (Kalata 1984), which gives its velocity;
/// a piece of a long group counts as still, because its ends depend on where the vehicle is.
class ObstacleTracks {
 public:
  struct Params {
    double range_m = 25;  ///< echoes beyond it are ignored; shorter than the range of the sensor, which is reported
                          ///< without an echo
    double range_min_m = 0.2;
    double gap_m = 1.5;
    double extent_m = 3;
    double gate_m = 2;  ///< maximum distance of a group from the predicted place of its track
    double alpha = 0.4;
    double beta = 0.08;
    double still_mps = 0.3;  ///< slower than this is still
    int hits = 5;            ///< scans after which the velocity of a track counts
    double memory_s = 2;     ///< time without an echo after which an obstacle is forgotten
  };
  explicit ObstacleTracks(const Params& params) : params_(params) {}

  /// Processes a scan, with the own position and heading at its time.  Ignored when the heading is unknown.
  void receive(const Scan& scan, const Motion& own);
  /// Returns the obstacles, extrapolated to `utime`.
  std::vector<Obstacle> at(std::int64_t utime) const;

 private:
  struct Group {
    Vector2d p_W = Vector2d::Zero();
    double radius_m = 0;
    bool alone = true;
  };
  struct Track {
    Obstacle obstacle;  ///< at `utime`
    std::int64_t utime = 0;
    int hits = 0;
    bool alone = true;
  };

  std::vector<Group> groups_of(const Scan& scan, const Motion& own) const;
  void update(Track& track, const Group& group, std::int64_t utime) const;
  Vector2d velocity_of(const Track& track) const;

  Params params_;
  std::vector<Track> tracks_;
};

}  // namespace autonomy
