// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "sim/base/math.hpp"

namespace sim {

/// What a ray is made of.  A material may let one kind through that it stops of another: a laser looks through glass.
enum class RayKind : std::uint8_t {
  any = 0,  ///< every material stops it
  light = 1,
  laser = 2,
  sound = 4
};

/// What a ray may hit.
struct RayFilter {
  std::uint32_t categories = ~0u;  ///< bits of the part categories that stop the ray; others are seen through
  int exclude_group = -1;          ///< a vehicle or object that the ray passes, by group number; -1: none
  RayKind kind = RayKind::any;
};

struct Ray {
  Vector3d origin_W = Vector3d::Zero();
  Vector3d direction_W = Vector3d::UnitX();  ///< of unit length
  double range_max_m = std::numeric_limits<double>::infinity();
};

/// Where a ray ends.  A ray that begins inside a part ends where it leaves the part.
struct RayHit {
  double range_m = std::numeric_limits<double>::infinity();
  Vector3d normal_W = Vector3d::Zero();  ///< of unit length, against the ray
  int part = -1;                         ///< number of the part in PhysicsWorld::parts(); -1: nothing was hit
  int material = 0;                      ///< number in PhysicsWorld::material(), where the ray hit the part

  bool hit() const { return part >= 0; }
  template <typename Archive>
  void visit_state(Archive& archive) {
    archive.not_only_finite(range_m);  // infinity: nothing was hit
    archive(normal_W, part, material);
  }
};

/// Rays in the xy-plane of the sensor frame S, the first at `first_angle_rad` from +x, counter-clockwise about +z.
struct Fan {
  Pose X_WS = Pose::Identity();
  double first_angle_rad = 0;
  double step_rad = 0;
  int count = 0;
  double range_max_m = 0;
};

/// What rays can hit: every part of the world, at its pose after the last step.  Of two parts that are hit at one range
/// the one with the lower number counts, so that an answer depends on nothing but the world.
class Scene {
 public:
  virtual ~Scene() = default;

  /// Looks where the parts are now.  Queries do so themselves when something has moved; before queries from several
  /// threads it must have been called.
  virtual void prepare() const = 0;
  /// Queries may come from several threads at once, once prepare() was called.
  virtual bool concurrent() const { return false; }

  /// The nearest hit within range.  `direction_W` has unit length.
  virtual std::optional<RayHit> cast(const Vector3d& origin_W, const Vector3d& direction_W, double range_max_m,
                                     const RayFilter& filter) const = 0;
  /// Each ray of the fan.  hits.size() == fan.count.
  virtual void cast_fan(const Fan& fan, const RayFilter& filter, std::span<RayHit> hits) const = 0;
  /// Many rays; fastest when neighbours in the list have nearly the same direction.  hits.size() == rays.size().
  virtual void cast(std::span<const Ray> rays, const RayFilter& filter, std::span<RayHit> hits) const;
  /// blocked[i] is 1 when something stands in ray i, else 0.  blocked.size() == rays.size().
  virtual void find_blocked(std::span<const Ray> rays, const RayFilter& filter, std::span<std::uint8_t> blocked) const;

  /// Something stands between two points.
  bool occluded(const Vector3d& from_W, const Vector3d& to_W, const RayFilter& filter) const;
};

}  // namespace sim
