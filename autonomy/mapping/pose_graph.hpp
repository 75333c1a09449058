// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "autonomy/mapping/scan_alignment.hpp"

namespace autonomy {

/// Returns the pose of `b` in the frame of `a`, both in one frame.
Pose2 seen_from(const Pose2& a, const Pose2& b);
/// Returns a pose in the frame of `a` as one in the frame of which `a` is a pose.
Pose2 composed(const Pose2& a, const Pose2& in_a);

/// Poses and what was measured between them, at their least squares (Lu and Milios 1997; Grisetti et al. 2010): by
/// Gauss-Newton with a sparse Cholesky decomposition.  The first pose is fixed.  A measurement that contradicts the
/// others loses weight (Huber).
class PoseGraph {
 public:
  /// Returns the number of the pose.
  int add_pose(const Pose2& pose);
  /// Adds the measured pose of `to` in the frame of `from`.
  void add_measurement(int from, int to, const Alignment& measured);
  void optimize(int iterations);

  const std::vector<Pose2>& poses() const { return poses_; }

 private:
  struct Measurement {
    int from, to;
    Alignment measured;
  };
  std::vector<Pose2> poses_;
  std::vector<Measurement> measurements_;
};

}  // namespace autonomy
