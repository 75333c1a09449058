// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tools/autonomy/mapping/occupancy_map.hpp"

namespace autonomy {

/// Pose of a scan in a map, with the mean of the likelihood field at the ends of its beams, 0 to 1.
struct ScanMatch {
  Pose2 pose;
  double score = 0;
};

/// Correlative scan matching (Olson 2009): the pose near a prediction at which the ends of the beams are the most
/// likely, by trying all poses of a window in steps of a cell, and then halving the steps around the best one.
class ScanMatcher {
 public:
  struct Params {
    double window_m = 0.2;     ///< of each coordinate, to both sides of the prediction
    double window_rad = 0.09;  ///< of the heading
    double step_rad = 0.0125;
    double prior_std_m = 0.1;  ///< standard deviation of the prediction, for directions that the scan leaves open
    double prior_std_rad = 0.05;
    double prior_weight = 0.02;  ///< loss of score at one standard deviation
  };
  explicit ScanMatcher(const Params& params) : params_(params) {}

  /// `points_B`: ends of beams in the frame of the vehicle.
  ScanMatch match(const OccupancyMap& map, const std::vector<Vector2d>& points_B, const Pose2& predicted) const;

 private:
  Params params_;
};

/// Returns the mean of the field at points in the frame of a pose.
double score_of(const OccupancyMap& map, const std::vector<Vector2d>& points_B, const Pose2& pose);

/// Beam that met something: where it began and ended, in the frame of the vehicle.
struct Sight {
  Vector2d from_B = Vector2d::Zero();
  Vector2d end_B = Vector2d::Zero();
};

/// Result of a search of the whole map.  The score of a pose is that of score_of() less the share of the beams that
/// pass through something in the map.
struct GlobalMatch {
  ScanMatch best;
  double other_score = 0;  ///< best score more than 1 m or 0.5 rad away
};

/// Searches the whole map, by branch and bound with the maxima of the field over growing squares (Hess et al. 2016).
/// Where too many places are alike it is given up.  None when no pose was found that scores more than `min_score`.
std::optional<GlobalMatch> search_map(const OccupancyMap& map, const std::vector<Sight>& sights, double min_score);

}  // namespace autonomy
