// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "autonomy/mapping/occupancy_map.hpp"

namespace autonomy {

/// Pose of a scan in a map, with the mean of the likelihood field at the ends of its beams, 0 to 1.
struct ScanMatch {
  Pose2 pose;
  double score = 0;
};

/// Correlative scan matching (Olson 2009): the pose near a prediction at which the ends of the beams are the most
/// likely, by trying all poses of a window in steps of a cell, and then climbing from the best one.  Not when climbing
/// from the prediction leads to a good score.
class ScanMatcher {
 public:
  struct Params {
    double window_m = 0.2;     ///< of each coordinate, to both sides of the prediction
    double window_rad = 0.09;  ///< of the heading
    double step_rad = 0.0125;
    double good_score = 0.6;  ///< from which on a pose near the prediction is not compared with the window
    /// Share of the beams that count as independent, against the prediction and in the covariance.
    double independent = 0.25;
  };
  explicit ScanMatcher(const Params& params) : params_(params) {}

  /// `points_B`: ends of beams in the frame of the vehicle; `information`: inverse of the covariance of the prediction,
  /// of x, y and yaw.
  ScanMatch match(const OccupancyMap& map, const std::vector<Vector2d>& points_B, const Pose2& predicted,
                  const Eigen::Matrix3d& information) const;
  /// Returns the information of a scan at its pose: the curvature of its score, where that is a maximum.
  Eigen::Matrix3d information_of(const OccupancyMap& map, const std::vector<Vector2d>& points_B,
                                 const Pose2& pose) const;

 private:
  Params params_;
};

/// Returns the mean of the field at points in the frame of a pose.
double score_of(const OccupancyMap& map, const std::vector<Vector2d>& points_B, const Pose2& pose);

}  // namespace autonomy
