#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "sim/math.hpp"

namespace sim {

/// What a ray may hit.
struct RayFilter {
  std::uint32_t categories = ~0u;  ///< bits of the part categories that stop the ray; others are seen through
  int exclude_group = -1;          ///< a vehicle or object that the ray passes, by group number; -1: none
};

struct RayHit {
  double range_m = 0;
  Vector3d normal_W = Vector3d::Zero();
  int part = -1;  ///< number of the part in PhysicsWorld::parts()
};

/// Rays in the xy-plane of the sensor frame S, the first at `first_angle_rad` from +x, counter-clockwise about +z.
struct Fan {
  Pose X_WS = Pose::Identity();
  double first_angle_rad = 0;
  double step_rad = 0;
  int count = 0;
  double range_max_m = 0;
};

/// What rays can hit: every part of the world, at its pose after the last step.
class Scene {
 public:
  virtual ~Scene() = default;
  /// The nearest hit within range.  `direction_W` has unit length.
  virtual std::optional<RayHit> cast(const Vector3d& origin_W, const Vector3d& direction_W, double range_max_m,
                                     const RayFilter& filter) const = 0;
  /// The range of each ray of the fan; infinity where nothing was hit.  ranges_m.size() == fan.count.
  virtual void cast_fan(const Fan& fan, const RayFilter& filter, std::span<double> ranges_m) const = 0;

  /// Something stands between two points.
  bool occluded(const Vector3d& from_W, const Vector3d& to_W, const RayFilter& filter) const {
    const Vector3d d = to_W - from_W;
    const double distance_m = d.norm();
    return distance_m > 0 && cast(from_W, d / distance_m, distance_m, filter).has_value();
  }
};

}  // namespace sim
