// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "sim/base/math.hpp"
#include "sim/rays/ray_shape.hpp"

namespace sim {

/// Volume that contains rays of nearly one direction, such as those of a tile of an image: a cone that widens from a
/// sphere around their origins.  It tells cheaply that none of them reaches a shape.
class RayBundle {
 public:
  /// Makes a volume that excludes nothing.
  RayBundle() = default;
  /// Makes a volume that contains all rays.  It excludes nothing when their directions differ by more than 30 degrees.
  explicit RayBundle(std::span<const Ray> rays);

  /// Whether it excludes anything.
  bool is_narrow() const { return narrow_; }
  /// Returns false only if no ray hits the sphere.
  bool may_reach(const Vector3d& center_W, double radius_m) const {
    const Vector3d displacement_W = center_W - origin_W_;
    const double ahead_m = displacement_W.dot(axis_W_);
    const double near_m = radius_m + radius_m_;
    if (ahead_m + near_m < 0 || ahead_m - near_m > range_m_) return !narrow_;
    const double aside_m = near_m + slope_ * (ahead_m + near_m);
    return displacement_W.squaredNorm() - ahead_m * ahead_m <= aside_m * aside_m || !narrow_;
  }
  /// Returns false only if no ray hits the shape.
  bool may_reach(const RayShape& shape) const {
    return shape.kind == RayShape::Kind::plane || may_reach(shape.center_W(), std::sqrt(shape.misses_beyond_m2));
  }

 private:
  bool narrow_ = false;
  Vector3d origin_W_ = Vector3d::Zero(), axis_W_ = Vector3d::UnitX();
  double radius_m_ = 0;  // of the sphere around the origins
  double slope_ = 0;     // tangent of the half angle of the cone
  double range_m_ = 0;   // the longest
};

}  // namespace sim
