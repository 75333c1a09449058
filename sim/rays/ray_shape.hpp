// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "sim/base/math.hpp"
#include "sim/geometry/box_grid.hpp"
#include "sim/rays/world_scene.hpp"
#include "sim/scene/scene.hpp"

namespace sim {

class TriangleScene;

/// Part for ray casting: its shape with its present pose in the world, and its transmission.
struct alignas(32) RayShape {
  enum class Kind : std::uint8_t { box, sphere, capsule, cylinder, plane, mesh };

  std::array<double, 3> center{};  ///< plane: any point on it
  std::array<double, 9> axes{};    ///< x, y and z axis of the shape in the world; plane: z is its normal
  /// Box and mesh: half lengths.  Sphere, capsule and cylinder: radius, radius squared, half length.
  std::array<double, 3> size{};
  int part = -1;
  int group = -1;
  std::uint32_t category = 0;
  int material = 0;
  Kind kind = Kind::box;
  std::uint8_t transmits = 0;
  const TriangleScene* mesh = nullptr;
  /// Squared distance of a ray's line from the center above which it misses.
  double misses_beyond_m2 = std::numeric_limits<double>::infinity();

  bool stops(const RayFilter& filter) const {
    return group != filter.exclude_group && (category & filter.categories) != 0 &&
           (transmits & static_cast<std::uint8_t>(filter.kind)) == 0;
  }
  Vector3d center_W() const { return {center[0], center[1], center[2]}; }
  Vector3d axis_W(int number) const { return {axes[3 * number], axes[3 * number + 1], axes[3 * number + 2]}; }
  /// Bounding radius about the center.  Not for a plane.
  double reach_m() const;
  /// Half extents along the axes of the world.  Not for a plane.
  Vector3d half_extents_W() const;
};

/// Makes a shape with kind and sizes of the part's geom; `mesh`: triangles of the part's mesh, if it has one.  Throws
/// std::logic_error for a geom without ray intersection.
RayShape make_ray_shape(int number, const ScenePart& part, const TriangleScene* mesh);
/// Copies the pose of the geom to the shape.
void follow(RayShape& shape, dxGeom* geom);

/// Up to eight rays, one per lane, and their nearest hits so far.
struct alignas(64) RayPacket {
  static constexpr int size = 8;
  static constexpr int no_part = std::numeric_limits<int>::max();

  double origin[3][size];     ///< x of all lanes, y of all lanes, z
  double direction[3][size];  ///< unit vectors
  double range_m[size];       ///< of the nearest hit; initially the maximum range
  const RayShape* shape[size];
  std::uint32_t triangle[size];  ///< of a hit mesh
  int part[size];
  bool coherent = false;  ///< neighbors have nearly the same direction

  void set(int lane, const Vector3d& origin_W, const Vector3d& direction_W, double range_max_m) {
    for (int i = 0; i < 3; ++i) {
      origin[i][lane] = origin_W[i];
      direction[i][lane] = direction_W[i];
    }
    range_m[lane] = range_max_m;
    part[lane] = no_part;
  }
  /// Fills an unused lane with valid numbers.
  void repeat(int from, int to) {
    for (int i = 0; i < 3; ++i) {
      origin[i][to] = origin[i][from];
      direction[i][to] = direction[i][from];
    }
    range_m[to] = -1;
    part[to] = no_part;
  }
  /// Whether a hit is nearer than the present one; at equal range the lower part number counts.
  bool nearer(int lane, double range, int number) const {
    return range < range_m[lane] || (range == range_m[lane] && number < part[lane]);
  }
  void hit(int lane, double range, const RayShape& by, std::uint32_t triangle_number = 0) {
    range_m[lane] = range;
    shape[lane] = &by;
    part[lane] = by.part;
    triangle[lane] = triangle_number;
  }
  Vector3d origin_W(int lane) const { return {origin[0][lane], origin[1][lane], origin[2][lane]}; }
  Vector3d direction_W(int lane) const { return {direction[0][lane], direction[1][lane], direction[2][lane]}; }
};

/// Whether a ray clearly misses the shape: a cheap test, as most candidates of a tree are missed by far.
inline bool passes_by(const RayShape& shape, const RayPacket& rays, int lane) {
  const double x = rays.origin[0][lane] - shape.center[0];
  const double y = rays.origin[1][lane] - shape.center[1];
  const double z = rays.origin[2][lane] - shape.center[2];
  const double vx = rays.direction[0][lane], vy = rays.direction[1][lane], vz = rays.direction[2][lane];
  const double along = x * vx + y * vy + z * vz;
  const double px = x - along * vx, py = y - along * vy, pz = z - along * vz;
  return px * px + py * py + pz * pz > shape.misses_beyond_m2;
}
/// Returns the lanes of `lanes` (bits) that do not clearly miss the shape.
unsigned near_lanes(const RayShape& shape, const RayPacket& rays, unsigned lanes);
/// Computes the range at which each lane of `lanes` (bits) hits the shape, which must not be a mesh: where it enters in
/// front of its origin, or leaves when it starts inside; infinity when it misses.  The bits of the result do not depend
/// on the number of lanes.  Other elements of `range_m` are undefined.
void find_ranges(const RayShape& shape, const RayPacket& rays, unsigned lanes, double (&range_m)[RayPacket::size]);
/// Transforms all lanes to the frame of the shape, which is not a plane: x of all lanes, y, z.
void transform_to(const RayShape& shape, const RayPacket& rays, double (&from)[3][RayPacket::size],
                  double (&direction)[3][RayPacket::size]);
/// Outward normal of a shape that is not a mesh, at a point on it.
Vector3d normal_at(const RayShape& shape, const Vector3d& point_W);

}  // namespace sim
