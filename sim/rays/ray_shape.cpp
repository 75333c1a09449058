// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rays/ray_shape.hpp"

#include <ode/ode.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

#include "sim/base/processor.hpp"
#include "sim/ode/ode_math.hpp"
#include "sim/rays/triangle_scene.hpp"

namespace sim {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using Kind = RayShape::Kind;

// The functions below have no branches, so that the compiler makes vector loops over lanes.
#define SHOAL_INLINE [[gnu::always_inline]] inline

/// Interval of a ray inside a convex body; empty when enter > leave.
struct Inside {
  double enter, leave;
};

SHOAL_INLINE double larger(double a, double b) {
  return a > b ? a : b;
}
SHOAL_INLINE double smaller(double a, double b) {
  return a < b ? a : b;
}

/// Ray in the frame of the shape.
struct LocalRay {
  double x, y, z, vx, vy, vz;
};

SHOAL_INLINE LocalRay to_local(const RayShape& shape, const RayPacket& rays, int lane) {
  const double x = rays.origin[0][lane] - shape.center[0];
  const double y = rays.origin[1][lane] - shape.center[1];
  const double z = rays.origin[2][lane] - shape.center[2];
  const double vx = rays.direction[0][lane], vy = rays.direction[1][lane], vz = rays.direction[2][lane];
  const auto& a = shape.axes;
  return {a[0] * x + a[1] * y + a[2] * z,    a[3] * x + a[4] * y + a[5] * z,    a[6] * x + a[7] * y + a[8] * z,
          a[0] * vx + a[1] * vy + a[2] * vz, a[3] * vx + a[4] * vy + a[5] * vz, a[6] * vx + a[7] * vy + a[8] * vz};
}

/// Limits the interval to -half..half along one axis.  A ray in the plane of a face (0 / 0) counts as inside:
/// comparisons with NaN change nothing.
SHOAL_INLINE Inside cut(Inside in, double from, double direction, double half) {
  const double inverse = 1 / (direction + 0.0);  // -0 becomes 0, consistent with `ahead`
  const double ahead = direction < 0 ? -half : half;
  const double enter = (-ahead - from) * inverse, leave = (ahead - from) * inverse;
  return {larger(enter, in.enter), smaller(leave, in.leave)};
}

SHOAL_INLINE Inside in_box(const RayShape& shape, const LocalRay& r) {
  Inside in{-infinity, infinity};
  in = cut(in, r.x, r.vx, shape.size[0]);
  in = cut(in, r.y, r.vy, shape.size[1]);
  return cut(in, r.z, r.vz, shape.size[2]);
}

/// Computed from the point of the ray nearest to the center, so that distant origins lose no digits by squaring.
SHOAL_INLINE Inside in_sphere(double x, double y, double z, double vx, double vy, double vz, double square_radius) {
  const double along = -(x * vx + y * vy + z * vz);
  const double px = x + along * vx, py = y + along * vy, pz = z + along * vz;
  const double rest = square_radius - (px * px + py * py + pz * pz);
  const double half = std::sqrt(larger(rest, 0));
  return {rest < 0 ? infinity : along - half, rest < 0 ? -infinity : along + half};
}

SHOAL_INLINE Inside in_cylinder(const RayShape& shape, const LocalRay& r) {
  const double a = r.vx * r.vx + r.vy * r.vy;
  const double inverse = 1 / a;
  const double along = -(r.x * r.vx + r.y * r.vy) * inverse;
  const double cross = r.x * r.vy - r.y * r.vx;
  // For a ray along the axis, use the distance of its origin from the axis.
  const double distance = a > 0 ? cross * cross * inverse : r.x * r.x + r.y * r.y;
  const double rest = shape.size[1] - distance;
  const double half = std::sqrt(larger(rest, 0) * inverse);
  const double enter = a > 0 ? along - half : -infinity, leave = a > 0 ? along + half : infinity;
  return cut({rest < 0 ? infinity : enter, rest < 0 ? -infinity : leave}, r.z, r.vz, shape.size[2]);
}

/// Union of a cylinder and two spheres, which is convex.
SHOAL_INLINE Inside in_capsule(const RayShape& shape, const LocalRay& r) {
  const Inside middle = in_cylinder(shape, r);
  const Inside low = in_sphere(r.x, r.y, r.z + shape.size[2], r.vx, r.vy, r.vz, shape.size[1]);
  const Inside high = in_sphere(r.x, r.y, r.z - shape.size[2], r.vx, r.vy, r.vz, shape.size[1]);
  // For a missed cylinder, enter > leave, with any values.
  const bool through = middle.enter <= middle.leave;
  return {smaller(smaller(through ? middle.enter : infinity, low.enter), high.enter),
          larger(larger(through ? middle.leave : -infinity, low.leave), high.leave)};
}

SHOAL_INLINE double range_of(const Inside& in) {
  const double range = in.enter >= 0 ? in.enter : in.leave;
  return in.enter <= in.leave && range >= 0 ? range : infinity;
}

template <Kind kind>
SHOAL_INLINE double range_to(const RayShape& shape, const RayPacket& rays, int lane) {
  if constexpr (kind == Kind::sphere) {
    const double x = rays.origin[0][lane] - shape.center[0];
    const double y = rays.origin[1][lane] - shape.center[1];
    const double z = rays.origin[2][lane] - shape.center[2];
    return range_of(
        in_sphere(x, y, z, rays.direction[0][lane], rays.direction[1][lane], rays.direction[2][lane], shape.size[1]));
  } else if constexpr (kind == Kind::plane) {
    const double height = shape.axes[6] * (rays.origin[0][lane] - shape.center[0]) +
                          shape.axes[7] * (rays.origin[1][lane] - shape.center[1]) +
                          shape.axes[8] * (rays.origin[2][lane] - shape.center[2]);
    // A ray parallel to the plane divides by 0. The infinity or NaN fails the comparison and counts as no hit.
    const double rate = shape.axes[6] * rays.direction[0][lane] + shape.axes[7] * rays.direction[1][lane] +
                        shape.axes[8] * rays.direction[2][lane];
    const double range = -height / rate;
    return range >= 0 ? range : infinity;
  } else {
    const LocalRay ray = to_local(shape, rays, lane);
    if constexpr (kind == Kind::box) return range_of(in_box(shape, ray));
    if constexpr (kind == Kind::capsule) return range_of(in_capsule(shape, ray));
    if constexpr (kind == Kind::cylinder) return range_of(in_cylinder(shape, ray));
  }
}

template <Kind kind>
SHOAL_INLINE void ranges_to(const RayShape& shape, const RayPacket& rays, unsigned lanes,
                            double (&range_m)[RayPacket::size]) {
  if (std::popcount(lanes) > 2) {
    for (int lane = 0; lane < RayPacket::size; ++lane) range_m[lane] = range_to<kind>(shape, rays, lane);
  } else {
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      range_m[lane] = passes_by(shape, rays, lane) ? infinity : range_to<kind>(shape, rays, lane);
    }
  }
}

SHOAL_INLINE void ranges_to_any(const RayShape& shape, const RayPacket& rays, unsigned lanes,
                                double (&range_m)[RayPacket::size]) {
  switch (shape.kind) {
    case Kind::box:
      return ranges_to<Kind::box>(shape, rays, lanes, range_m);
    case Kind::sphere:
      return ranges_to<Kind::sphere>(shape, rays, lanes, range_m);
    case Kind::capsule:
      return ranges_to<Kind::capsule>(shape, rays, lanes, range_m);
    case Kind::cylinder:
      return ranges_to<Kind::cylinder>(shape, rays, lanes, range_m);
    case Kind::plane:
      return ranges_to<Kind::plane>(shape, rays, lanes, range_m);
    case Kind::mesh:
      break;
  }
}

SHOAL_INLINE void transform_all_to(const RayShape& shape, const RayPacket& rays, double (&from)[3][RayPacket::size],
                                   double (&direction)[3][RayPacket::size]) {
  const auto& a = shape.axes;
  const auto& c = shape.center;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < RayPacket::size; ++i) {
      from[axis][i] = a[3 * axis] * (rays.origin[0][i] - c[0]) + a[3 * axis + 1] * (rays.origin[1][i] - c[1]) +
                      a[3 * axis + 2] * (rays.origin[2][i] - c[2]);
      direction[axis][i] = a[3 * axis] * rays.direction[0][i] + a[3 * axis + 1] * rays.direction[1][i] +
                           a[3 * axis + 2] * rays.direction[2][i];
    }
}

/// Like passes_by(), for all lanes.
SHOAL_INLINE unsigned near_lanes_of(const RayShape& shape, const RayPacket& rays) {
  double over_m2[RayPacket::size];
  const auto& c = shape.center;
  for (int i = 0; i < RayPacket::size; ++i) {
    const double x = rays.origin[0][i] - c[0], y = rays.origin[1][i] - c[1], z = rays.origin[2][i] - c[2];
    const double vx = rays.direction[0][i], vy = rays.direction[1][i], vz = rays.direction[2][i];
    const double along = x * vx + y * vy + z * vz;
    const double px = x - along * vx, py = y - along * vy, pz = z - along * vz;
    over_m2[i] = px * px + py * py + pz * pz;
  }
  unsigned lanes = 0;
  for (int i = 0; i < RayPacket::size; ++i) lanes |= static_cast<unsigned>(!(over_m2[i] > shape.misses_beyond_m2)) << i;
  return lanes;
}

#undef SHOAL_INLINE

unsigned near_lanes_baseline(const RayShape& shape, const RayPacket& rays) {
  return near_lanes_of(shape, rays);
}

SHOAL_AVX2 unsigned near_lanes_avx2(const RayShape& shape, const RayPacket& rays) {
  return near_lanes_of(shape, rays);
}

void ranges_baseline(const RayShape& shape, const RayPacket& rays, unsigned lanes, double (&range_m)[RayPacket::size]) {
  ranges_to_any(shape, rays, lanes, range_m);
}

void see_baseline(const RayShape& shape, const RayPacket& rays, double (&from)[3][RayPacket::size],
                  double (&direction)[3][RayPacket::size]) {
  transform_all_to(shape, rays, from, direction);
}

SHOAL_AVX2 void ranges_avx2(const RayShape& shape, const RayPacket& rays, unsigned lanes,
                            double (&range_m)[RayPacket::size]) {
  ranges_to_any(shape, rays, lanes, range_m);
}

SHOAL_AVX2 void see_avx2(const RayShape& shape, const RayPacket& rays, double (&from)[3][RayPacket::size],
                         double (&direction)[3][RayPacket::size]) {
  transform_all_to(shape, rays, from, direction);
}

}  // namespace

unsigned near_lanes(const RayShape& shape, const RayPacket& rays, unsigned lanes) {
  static const auto best = has_avx2() ? near_lanes_avx2 : near_lanes_baseline;
  return lanes & best(shape, rays);
}

void find_ranges(const RayShape& shape, const RayPacket& rays, unsigned lanes, double (&range_m)[RayPacket::size]) {
  static const auto best = has_avx2() ? ranges_avx2 : ranges_baseline;
  best(shape, rays, lanes, range_m);
}

void transform_to(const RayShape& shape, const RayPacket& rays, double (&from)[3][RayPacket::size],
                  double (&direction)[3][RayPacket::size]) {
  static const auto best = has_avx2() ? see_avx2 : see_baseline;
  best(shape, rays, from, direction);
}

Vector3d RayShape::half_extents_W() const {
  const auto turned = [&](double x, double y, double z) {
    return Vector3d(x * axis_W(0).cwiseAbs() + y * axis_W(1).cwiseAbs() + z * axis_W(2).cwiseAbs());
  };
  switch (kind) {
    case Kind::sphere:
      return Vector3d::Constant(size[0]);
    case Kind::capsule:
      return turned(0, 0, size[2]) + Vector3d::Constant(size[0]);
    case Kind::cylinder:
      // The disc at each end reaches sqrt(1 - a^2) of its radius along a world axis whose cosine with the axis is a.
      return turned(0, 0, size[2]) + size[0] * (1 - axis_W(2).array().square()).max(0).sqrt().matrix();
    default:
      return turned(size[0], size[1], size[2]);
  }
}

double RayShape::reach_m() const {
  switch (kind) {
    case Kind::sphere:
      return size[0];
    case Kind::capsule:
      return size[0] + size[2];
    case Kind::cylinder:
      return std::sqrt(size[1] + size[2] * size[2]);
    default:
      return std::sqrt(size[0] * size[0] + size[1] * size[1] + size[2] * size[2]);
  }
}

namespace {

/// Sets kind and sizes of the shape from the geom.
void take_sizes(RayShape& shape, int number, const ScenePart& part, const TriangleScene* mesh) {
  // Sizes of a sphere, capsule or cylinder.
  const auto round = [&](Kind kind, double radius_m, double length_m) {
    shape.kind = kind;
    shape.size = {radius_m, radius_m * radius_m, length_m / 2};
  };
  dReal radius = 0, length = 0;
  dVector3 lengths;
  // Mesh: its bounding box.
  if (mesh != nullptr) {
    shape.kind = Kind::mesh;
    const Vector3d half = mesh->half_extents_m();
    shape.size = {half.x(), half.y(), half.z()};
    return;
  }
  // Other shapes: sizes of the geom.
  switch (dGeomGetClass(part.geom)) {
    case dBoxClass:
      dGeomBoxGetLengths(part.geom, lengths);
      shape.kind = Kind::box;
      shape.size = {lengths[0] / 2, lengths[1] / 2, lengths[2] / 2};
      break;
    case dSphereClass:
      round(Kind::sphere, dGeomSphereGetRadius(part.geom), 0);
      break;
    case dCapsuleClass:
      dGeomCapsuleGetParams(part.geom, &radius, &length);
      round(Kind::capsule, radius, length);
      break;
    case dCylinderClass:
      dGeomCylinderGetParams(part.geom, &radius, &length);
      round(Kind::cylinder, radius, length);
      break;
    case dPlaneClass:
      shape.kind = Kind::plane;
      break;
    default:
      throw std::logic_error("part " + std::to_string(number) + " has a shape without a surface for rays");
  }
}

}  // namespace

RayShape make_ray_shape(int number, const ScenePart& part, const TriangleScene* mesh) {
  RayShape shape;
  shape.part = number;
  shape.group = part.group;
  shape.category = part.category;
  shape.material = part.material;
  shape.transmits = part.transmits;
  shape.mesh = mesh;
  take_sizes(shape, number, part, mesh);
  // Includes a margin for rounding at any distance.
  if (shape.kind != Kind::plane) shape.misses_beyond_m2 = std::pow(1.001 * shape.reach_m() + 1e-3, 2);
  return shape;
}

void follow(RayShape& shape, dGeomID geom) {
  // ODE stores a plane as n x = d in the world frame, without a position.
  if (shape.kind == Kind::plane) {
    dVector4 plane;
    dGeomPlaneGetParams(geom, plane);
    for (int i = 0; i < 3; ++i) {
      shape.axes[6 + i] = plane[i];
      shape.center[i] = plane[i] * plane[3];
    }
    return;
  }
  const dReal* p = dGeomGetPosition(geom);
  std::copy_n(p, 3, shape.center.begin());
  if (shape.kind == Kind::sphere) return;
  const dReal* R = dGeomGetRotation(geom);
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < 3; ++i) shape.axes[3 * axis + i] = R[4 * i + axis];
  if (shape.kind != Kind::mesh) return;
  // The shape is centered on the bounding box of the mesh, not on its origin, for the box test before the triangles.
  const Vector3d c = shape.mesh->center_m();
  for (int i = 0; i < 3; ++i)
    shape.center[i] += shape.axes[i] * c.x() + shape.axes[3 + i] * c.y() + shape.axes[6 + i] * c.z();
}

Vector3d normal_at(const RayShape& shape, const Vector3d& point_W) {
  const Vector3d to_point = point_W - shape.center_W();
  if (shape.kind == Kind::plane) return shape.axis_W(2);
  if (shape.kind == Kind::sphere) return to_point.normalized();
  const Vector3d x = shape.axis_W(0), y = shape.axis_W(1), z = shape.axis_W(2);
  const double height = z.dot(to_point);
  if (shape.kind == Kind::capsule)
    return (to_point - std::clamp(height, -shape.size[2], shape.size[2]) * z).normalized();
  const double end = std::abs(height) - shape.size[2];
  const Vector3d up = height < 0 ? Vector3d(-z) : z;
  if (shape.kind == Kind::cylinder) {
    const Vector3d out = to_point - height * z;
    const double distance = out.norm();
    return end > distance - shape.size[0] ? up : Vector3d(out / distance);
  }
  // Face of the box that the point is on, or next to by rounding.
  const double px = x.dot(to_point), py = y.dot(to_point);
  const double over_x = std::abs(px) - shape.size[0], over_y = std::abs(py) - shape.size[1];
  if (over_x >= over_y && over_x >= end) return px < 0 ? Vector3d(-x) : x;
  if (over_y >= end) return py < 0 ? Vector3d(-y) : y;
  return up;
}

}  // namespace sim
