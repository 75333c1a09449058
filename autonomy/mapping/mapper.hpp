// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "autonomy/filters/odometer.hpp"
#include "autonomy/mapping/place_search.hpp"
#include "autonomy/mapping/pose_graph.hpp"
#include "autonomy/mapping/scan_alignment.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/occupancy_grid_t.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/planar_lidar_t.hpp"

namespace autonomy {

/// Mean of the scans of a lidar at rest, whose errors average out.  A value.
class MeanScan {
 public:
  /// A scan with other beams than the first one has no effect.
  void add(const shoal::planar_lidar_t& scan);
  void clear() { *this = {}; }
  /// Returns the first scan with the mean ranges; none without a scan.  Ranges that differ from the first by more than
  /// 0.2 m do not count.  A beam with many of them, as one that grazes an edge, has range 0.
  std::optional<shoal::planar_lidar_t> scan() const;

 private:
  std::optional<shoal::planar_lidar_t> first_;
  int count_ = 0;
  Eigen::ArrayXd off_m_;   ///< sum of the differences to the first scan that count
  Eigen::ArrayXi counts_;  ///< their number
};

/// Simultaneous localization and mapping by a planar lidar and odometry: a pure function of the messages in their
/// order, independent of clock and bus.  Its copy is its whole state.
///
///   - survey: the first `survey_scans` scans are poses of a graph.  Each is aligned with those near it, so that loops
///   close, and the map is drawn again when the poses have moved.  The first pose is that of the start: its scan, whose
///   errors would be those of the whole map, is the mean of all until the vehicle leaves.
///   - track: each scan is matched to the map near the pose that odometry predicts, and then added to the map.
///   - lost: several scans in a row do not match the map, as after the vehicle was carried or left the mapped area.
///   The whole map is searched for its place, and nothing is added to it.
class Mapper {
 public:
  struct Params {
    Pose2 start;  ///< pose of the vehicle at the start, in the frame of the map
    OccupancyMap::Params map;
    ScanMatcher::Params matcher;
    LidarMount lidar;
    double rest_mps = 0.003;            ///< odometry below both is noise at rest
    double rest_radps = 0.01;           ///< and does not move the pose
    double survey_m = 0.1;              ///< a scan is added to the survey after this distance
    double survey_rad = 0.05;           ///< or this turn
    double insert_m = 1;                ///< later scans are added to the map after this distance
    double insert_rad = 0.3;            ///< or this turn
    double insert_s = 20;               ///< or this time
    double min_evidence = 0.1;          ///< of a scan, see Fit
    double min_survey_evidence = -0.3;  ///< in the survey, when much is unknown
    double min_near = 0.25;             ///< and share of its beams that end near something
    double certain_evidence = 0.6;      ///< from which on a lost vehicle is where it was
    int max_bad_scans = 5;              ///< consecutive ones below it; then the vehicle is lost
    int survey_scans = 400;
    double redraw_m = 0.02;  ///< the map is drawn again when a pose of the survey has moved by this
    PlaceSearch::Params search;
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
  /// Scan of the survey.
  struct Surveyed {
    std::shared_ptr<const Beams> beams;
    std::shared_ptr<const Outline> outline;
    std::int64_t utime = 0;
    Pose2 drawn;  ///< pose at which it was drawn into the map
  };
  /// Moves pose and covariance by odometry.
  void predict(const Increment& moved);
  /// `rests`: it has not moved since the last scan.
  void track(const Beams& beams, const Increment& moved, bool rests);
  void search(const Beams& beams, const Increment& moved);
  /// Adds a scan to the graph, and with it to the map.
  void survey(const Beams& beams);
  void end_survey();
  /// Aligns the last scan of the survey with another one.  Returns whether they fit.
  bool close_loop(std::size_t other);
  void insert(const Beams& beams, const Pose2& pose, std::int64_t utime);
  void redraw();
  shoal::estimate_t estimate() const;

  Params params_;
  OccupancyMap map_;
  ScanMatcher matcher_;
  Pose2 pose_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();  ///< of x, y and yaw
  std::optional<shoal::odometry_t> odometry_;
  std::optional<shoal::planar_lidar_t> scan_;
  Odometer odometer_;
  bool missed_odometry_ = false;
  std::int64_t utime_ = 0;  ///< time of the pose
  // Tracking.
  bool has_map_ = false;
  std::int64_t first_utime_ = 0;  ///< from which the map counts its time
  Pose2 inserted_;                ///< pose of the last scan in the map
  std::int64_t inserted_utime_ = 0;
  double still_score_ = 0;  ///< score where it stands, after the last match
  std::int64_t matched_utime_ = 0;
  int bad_scans_ = 0;
  // Survey.
  bool surveys_ = true;
  MeanScan first_scan_;
  bool left_ = false;  ///< it has moved since the first scan
  PoseGraph graph_;
  std::vector<Surveyed> surveyed_;
  Pose2 since_survey_;  ///< move since the last of them, by odometry
  // Lost.
  bool lost_ = false;
  int times_lost_ = 0;
  PlaceSearch search_;
};

}  // namespace autonomy
