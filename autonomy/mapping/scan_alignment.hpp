// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "autonomy/filters/pose2.hpp"

namespace autonomy {

/// Points of a scan in the order of its beams, in the frame of the vehicle, with the line through their neighbors.
class Outline {
 public:
  Outline() = default;
  explicit Outline(std::vector<Vector2d> points_B);

  struct Line {
    Vector2d normal_B = Vector2d::Zero();  ///< zero: its neighbors are not on one line with it
    double half_length_m = 0;              ///< to the middle of the way to the next point
  };
  const std::vector<Vector2d>& points_B() const { return points_B_; }
  const Line& line(std::size_t point) const { return lines_[point]; }

 private:
  std::vector<Vector2d> points_B_;
  std::vector<Line> lines_;
};

/// Pose of one frame in another with the information about it: the inverse of its covariance, in m and rad.
struct Alignment {
  Pose2 pose;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

/// Returns the pose of the vehicle of `scan` in the frame of that of `reference`, near a first guess: the points of one
/// are brought onto the lines of the other (iterative closest point with a point-to-line metric, Censi 2008), with
/// Cauchy weights.  Points are paired with lines up to `gate_m` away at first, and up to 6 cm at last.  std::nullopt
/// when fewer than 0.4 of the points find a line.
std::optional<Alignment> align(const Outline& reference, const Outline& scan, const Pose2& guess, double gate_m);

}  // namespace autonomy
