// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "sim/base/math.hpp"

namespace sim {

enum class PathKind {
  waypoints,  ///< straight lines
  spline,     ///< centripetal Catmull-Rom
  timed,      ///< poses at times
};

/// Pose at a time.
struct TimedPose {
  double at_s = 0;
  Vector3d position_m = Vector3d::Zero();
  Vector3d rpy_rad = Vector3d::Zero();
};

/// Curve in the world frame with an orientation at each point.  Its parameter u runs from 0 to length(): meters along a
/// path of waypoints or a spline, seconds since the first pose along a timed path.
class Path {
 public:
  /// Makes a path through points.  Consecutive points must differ.  `closed`: returns from the last point to the first.
  /// Without `R_WO` the +x axis follows the path direction (in the horizontal plane, z up).
  static Path through(PathKind kind, std::vector<Vector3d> points_W, bool closed, std::optional<Matrix3d> R_WO);
  /// Makes a path through timed poses.  Times must increase.
  static Path timed(const std::vector<TimedPose>& poses);

  double length() const { return starts_.back(); }
  Pose pose_at(double u) const;

 private:
  /// p(t) = c0 + c1 t + c2 t^2 + c3 t^3 for t from 0 to 1.
  struct Cubic {
    Vector3d c[4];
    Vector3d at(double t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
    Vector3d slope(double t) const { return c[1] + t * (2 * c[2] + t * 3 * c[3]); }
    double length(double from, double to) const;
  };

  Path() = default;
  void add_lines(const std::vector<Vector3d>& points_W);
  void add_spline(const std::vector<Vector3d>& points_W, bool closed);
  Pose timed_pose_at(std::size_t i, double u) const;
  double parameter_at(std::size_t i, double u) const;

  PathKind kind_ = PathKind::waypoints;
  std::optional<Matrix3d> R_WO_;
  // Pieces between starts_[i] and starts_[i + 1]; a spline has several per segment, which start at from_[i].
  std::vector<double> starts_{0.0};
  std::vector<Cubic> cubics_;
  std::vector<double> from_, to_;
  std::vector<Pose> poses_;
};

}  // namespace sim
