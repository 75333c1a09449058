// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "autonomy/mapping/lidar_odometry.hpp"
#include "autonomy/mapping/occupancy_map.hpp"
#include "autonomy/mapping/scan_matcher.hpp"

namespace autonomy {

/// Finds the place of a vehicle that may be anywhere in the map.  The places where a first scan fits are followed by
/// odometry and matched with each further view, until one of them fits clearly better than all others; when none does
/// for long, it begins again.  A value: its copy is its whole state.
class PlaceSearch {
 public:
  struct Params {
    std::size_t candidates = 40;  ///< places that are followed
    double step_m = 0.4;          ///< between the places that are tried
    double step_rad = 0.0873;
    double apart_m = 0.3, apart_rad = 0.3;  ///< move or turn between views
    int min_views = 3;                      ///< before one is accepted
    int max_views = 16;                     ///< then it begins again
    double min_mean = 0.6;                  ///< mean evidence of a view to be accepted, see Fit
    double expected_lead = 0.5;             ///< evidence for the place where it is if it was not carried
    double lead = 0.6;                      ///< sum by which it is ahead of all others
  };
  explicit PlaceSearch(const Params& params) : params_(params) {}

  /// Moves all candidates by odometry.
  void move(const Increment& by);
  /// Takes a scan.  `expected`: pose by odometry, if the vehicle was not carried.  Returns the place once it is found.
  std::optional<Pose2> look(const OccupancyMap& map, const ScanMatcher& matcher, const Beams& beams,
                            const Pose2& expected);

 private:
  struct Candidate {
    Pose2 pose;
    double evidence = 0;  ///< sum over the views
  };
  void begin(const OccupancyMap& map, const ScanMatcher& matcher, const Beams& beams, const Pose2& expected);
  /// Leaves the best candidates that are not at one place, best first.
  void sort(std::size_t max);

  Params params_;
  std::vector<Candidate> candidates_;
  int views_ = 0;
  Increment since_view_;
};

/// A scan with fewer points says too little about the place.
inline constexpr std::size_t min_judged_points = 40;

/// How a scan fits to the map at a pose: shares of the beams that met something.
struct Fit {
  double near = 0;           ///< end near something
  double contradicting = 0;  ///< end in what is known as free, or pass through something
  double through = 0;        ///< of these, pass through something and end near something
  double ends_near() const { return near + through; }
  double evidence() const { return near - contradicting; }
};
/// `enough_near`: looks at no more beams when this share of them ends near something.
Fit fit_of(const OccupancyMap& map, const Beams& beams, const Pose2& pose, double enough_near = 1);

/// Covariance of a place that is only guessed.
Eigen::Matrix3d loose_covariance();

}  // namespace autonomy
