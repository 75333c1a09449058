// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "shoal/estimate_t.hpp"
#include "shoal/occupancy_grid_t.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "tools/autonomy/filters/odometer.hpp"
#include "tools/autonomy/mapping/occupancy_map.hpp"
#include "tools/autonomy/mapping/scan_matcher.hpp"

namespace autonomy {

/// Simultaneous localisation and mapping by a planar lidar and odometry: a pure function of the messages in their
/// order, independent of clock and bus.  Its copy is its whole state.
///
///   - track: each scan is matched to the map near the pose that odometry predicts, and then added to the map.
///   - lost: several scans in a row hit what the map has as free, as after the vehicle was carried.  It collects scans
///   by
///     odometry and searches the whole map until one pose is clearly the best.  Nothing is added to the map.
class Mapper {
 public:
  struct Params {
    Pose2 start;  ///< pose of the vehicle at the start, in the frame of the map
    OccupancyMap::Params map;
    ScanMatcher::Params matcher;
    Pose2 lidar;                     ///< pose of the lidar on the vehicle
    double lidar_range_m = 20;       ///< a beam of this length has met nothing
    double use_range_m = 15;         ///< longer beams only clear this length
    double insert_m = 0.1;           ///< a scan is added after this distance
    double insert_rad = 0.05;        ///< or this turn
    double insert_s = 10;            ///< or this time
    double min_agreement = 0.25;     ///< share of the beams in known cells that must end near something in the map
    double certain_agreement = 0.6;  ///< share of them from which on a lost vehicle is where it was
    int max_bad_scans = 4;           ///< consecutive ones below it; then the vehicle is lost
    double search_s = 3;  ///< time between the first searches of the whole map; it doubles up to max_search_s
    double max_search_s = 12;
    double accept_score = 0.5;  ///< score of a pose to be accepted
    double accept_lead = 0.1;   ///< and its lead over any other pose
    double last_lead = 0.03;    ///< lead that suffices when it has seen all around
  };

  explicit Mapper(const Params& params);

  /// Throws shoal::MessageError for numbers that no vehicle reaches.
  void receive(const shoal::odometry_t& odometry);
  /// Takes a scan; of several before a tick the last counts.
  void receive(const shoal::planar_lidar_t& scan);
  /// Processes the last scan.  Returns the pose of its time; none without a new scan and odometry.
  std::optional<shoal::estimate_t> step();
  /// Returns the map at the time of the last scan.
  shoal::occupancy_grid_t map_message() const;

  const Pose2& pose() const { return pose_; }
  const OccupancyMap& map() const { return map_; }
  bool is_lost() const { return lost_; }
  int times_lost() const { return times_lost_; }

 private:
  /// Scan in the frame of the vehicle.
  struct Beams {
    std::vector<Vector2d> ends_B;
    std::vector<char> hits;
    std::vector<Vector2d> points_B;  ///< of the hits
  };
  Beams beams_of(const shoal::planar_lidar_t& scan) const;
  Increment moved_since_scan();
  void track(const Beams& beams, const Increment& moved);
  void search(const Beams& beams);
  /// Returns the share of points in known cells that end near something; none when there are too few.
  std::optional<double> agreement(const std::vector<Vector2d>& points_B, const Pose2& pose) const;
  void insert(const Beams& beams);
  shoal::estimate_t estimate() const;

  Params params_;
  OccupancyMap map_;
  ScanMatcher matcher_;
  Pose2 pose_;
  std::optional<shoal::odometry_t> odometry_;
  std::optional<shoal::planar_lidar_t> scan_;
  Odometer odometer_;
  std::int64_t utime_ = 0;  ///< time of the pose
  // Tracking.
  bool has_map_ = false;
  std::int64_t first_utime_ = 0;  ///< from which the map counts its time
  Pose2 inserted_;                ///< pose of the last scan in the map
  std::int64_t inserted_utime_ = 0;
  double still_score_ = 0;  ///< score where it stands, after the last match
  std::int64_t matched_utime_ = 0;
  int bad_scans_ = 0;
  // Lost.
  bool lost_ = false;
  int times_lost_ = 0;
  std::vector<Sight> collected_;  ///< beams of the scans since then, in the frame of the vehicle now
  Pose2 collected_at_;            ///< pose by odometry of the last scan among them
  std::int64_t searched_utime_ = 0;
  double next_search_s_ = 0;  ///< time from that search to the next one
};

}  // namespace autonomy
