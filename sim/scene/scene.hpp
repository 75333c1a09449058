// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "sim/base/math.hpp"
#include "sim/config/choice_words.hpp"

namespace sim {

/// Physical kind of a ray.  A material may transmit one kind and block another; glass, for example, transmits lasers.
enum class RayKind : std::uint8_t {
  any = 0,  ///< blocked by every material
  light = 1,
  laser = 2,
  sound = 4
};

/// Selection of the parts that a ray can hit.
struct RayFilter {
  std::uint32_t categories = ~0u;  ///< bit mask of part categories that block the ray
  int exclude_group = -1;          ///< group number of a vehicle or object that the ray ignores; -1: none
  RayKind kind = RayKind::any;
};

/// Ray in the world frame.
struct Ray {
  Vector3d origin_W = Vector3d::Zero();
  Vector3d direction_W = Vector3d::UnitX();  ///< unit vector
  double range_max_m = std::numeric_limits<double>::infinity();
};

/// First hit of a ray.  A ray that begins inside a part hits its surface from inside.
struct RayHit {
  double range_m = std::numeric_limits<double>::infinity();
  Vector3d normal_W = Vector3d::Zero();  ///< unit vector, opposed to the ray
  int part = -1;                         ///< index in PhysicsWorld::parts(); -1: no hit
  int material = 0;                      ///< number for PhysicsWorld::material(), at the point hit

  bool hit() const { return part >= 0; }
  template <typename Archive>
  void visit_state(Archive& archive) {
    archive.not_only_finite(range_m);  // infinity: no hit
    archive(normal_W, part, material);
  }
};

/// Fan of rays in the xy-plane of the sensor frame S, counter-clockwise about +z, the first at `first_angle_rad` from
/// +x.
struct Fan {
  Pose X_WS = Pose::Identity();
  double first_angle_rad = 0;
  double step_rad = 0;
  int count = 0;
  double range_max_m = 0;
};

/// Interface for ray casting against every part of the world at its pose after the last step.  If two parts are hit
/// at the same range the one with the lower number is reported, so that results are reproducible.
class Scene {
 public:
  virtual ~Scene() = default;

  /// Updates the poses of the parts.  Queries do this automatically after a motion; it must be called explicitly before
  /// queries from several threads.
  virtual void prepare() const = 0;
  /// Returns true when several threads may query at once after prepare().
  virtual bool concurrent() const { return false; }

  /// Returns the nearest hit within range; empty when there is none.  `direction_W` is a unit vector.
  virtual std::optional<RayHit> cast(const Vector3d& origin_W, const Vector3d& direction_W, double range_max_m,
                                     const RayFilter& filter) const = 0;
  /// Casts all rays of a fan.  hits.size() == fan.count.
  virtual void cast_fan(const Fan& fan, const RayFilter& filter, std::span<RayHit> hits) const = 0;
  /// Casts many rays; fastest when neighboring rays have similar directions.  hits.size() == rays.size().
  virtual void cast(std::span<const Ray> rays, const RayFilter& filter, std::span<RayHit> hits) const;
  /// Sets blocked[i] to 1 when ray i has any hit within range, else to 0.  blocked.size() == rays.size().
  virtual void find_blocked(std::span<const Ray> rays, const RayFilter& filter, std::span<std::uint8_t> blocked) const;

  /// Returns true when a part blocks the line between two points.
  bool occluded(const Vector3d& from_W, const Vector3d& to_W, const RayFilter& filter) const;
};

/// Library for ray casting.
enum class RayLibrary { embree, ode };

inline constexpr ChoiceWords<RayLibrary> ray_library_words{{"embree", RayLibrary::embree}, {"ode", RayLibrary::ode}};

}  // namespace sim
