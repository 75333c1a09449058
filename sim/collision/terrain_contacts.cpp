// SPDX-License-Identifier: BSD-3-Clause
// Contacts with the smooth surface of terrain.  Each shape is tested at a bounded number of points, so that the cost of
// a contact does not depend on the cell size.  Depths are along the normal of the surface at the point; everything
// below is solid, so that a part is pushed out from any depth.
#include <algorithm>
#include <array>
#include <cmath>

#include "sim/collision/terrain_geom.hpp"
#include "sim/ode/ode_math.hpp"

namespace sim {
namespace {

constexpr int max_touches = 80;
/// A point between others adds a contact only where the ground is higher by more than this than their plane.
constexpr double bulge_m = 1e-6;

/// Contact candidate: a point of a shape, and the ground there.
struct Touch {
  Vector3d position_T;
  Vector3d normal_T;  ///< of the ground, upwards
  double depth_m;     ///< negative above the ground
};

Touch no_touch() {
  return {Vector3d::Zero(), Vector3d::UnitZ(), -1e30};
}

class Touches {
 public:
  void add(const Touch& touch) {
    if (touch.depth_m >= 0 && count_ < max_touches) all_[static_cast<std::size_t>(count_++)] = touch;
  }
  /// Moves the deepest point to the front, and then repeatedly the point farthest from those selected.  A few contacts
  /// then support a shape as well as all of them.
  int choose(int max) {
    std::array<double, max_touches> away;
    std::fill_n(away.begin(), count_, 1e30);
    const int chosen = std::min(max, count_);
    for (int k = 0; k < chosen; ++k) {
      int best = k;
      for (int i = k + 1; i < count_; ++i)
        if (k == 0 ? all_[i].depth_m > all_[best].depth_m : away[i] > away[best]) best = i;
      std::swap(all_[k], all_[best]);
      std::swap(away[k], away[best]);
      for (int i = k + 1; i < count_; ++i)
        away[i] = std::min(away[i], (all_[i].position_T - all_[k].position_T).squaredNorm());
    }
    return chosen;
  }
  const Touch& operator[](int i) const { return all_[static_cast<std::size_t>(i)]; }

 private:
  std::array<Touch, max_touches> all_;
  int count_ = 0;
};

/// Contact of a point.  The depth is exact to first order in the curvature of the ground.
Touch touch_at(const HeightGrid& grid, const Vector3d& p_T) {
  if (!grid.contains(p_T.x(), p_T.y())) return no_touch();
  const SurfacePoint surface = grid.smooth_at(p_T.x(), p_T.y());
  const Vector3d normal_T = surface.normal();
  return {p_T, normal_T, (surface.height_m - p_T.z()) * normal_T.z()};
}

/// Point of the ground nearest to the center of a sphere, by Newton's method on the squared distance.  Where the
/// Hessian is not positive definite due to curvature, the curvature is left out (Gauss-Newton).
Touch touch_sphere(const HeightGrid& grid, const Vector3d& c_T, double radius_m) {
  if (!grid.contains(c_T.x(), c_T.y())) return no_touch();
  SurfacePoint surface = grid.smooth_at(c_T.x(), c_T.y());
  // The nearest point cannot be farther away horizontally than the vertical distance to the ground.
  const double reach_m = std::abs(surface.height_m - c_T.z());
  double x = 0, y = 0;  // relative to the center
  for (int i = 0; i < 4; ++i) {
    // Gradient and Hessian of half the squared distance.
    const double up = surface.height_m - c_T.z();
    const double g_x = x + up * surface.slope_x, g_y = y + up * surface.slope_y;
    const double a = 1 + surface.slope_x * surface.slope_x, b = surface.slope_x * surface.slope_y,
                 c = 1 + surface.slope_y * surface.slope_y;
    double h_xx = a + up * surface.bend_xx_pm, h_xy = b + up * surface.bend_xy_pm, h_yy = c + up * surface.bend_yy_pm;
    if (h_xx < 0.1 || h_xx * h_yy - h_xy * h_xy < 0.1) {
      h_xx = a;
      h_xy = b;
      h_yy = c;
    }
    // Newton step, limited to the reach.
    const double det = h_xx * h_yy - h_xy * h_xy;
    const double step_x = (h_xy * g_y - h_yy * g_x) / det, step_y = (h_xy * g_x - h_xx * g_y) / det;
    if (step_x * step_x + step_y * step_y <= 1e-18 * radius_m * radius_m) break;
    x += step_x;
    y += step_y;
    const double away_m = std::hypot(x, y);
    if (away_m > reach_m) {
      x *= reach_m / away_m;
      y *= reach_m / away_m;
    }
    surface = grid.smooth_at(c_T.x() + x, c_T.y() + y);
  }
  // Depth along the normal at the nearest point.
  const Vector3d normal_T = surface.normal();
  const double height_m = normal_T.dot(Vector3d(-x, -y, c_T.z() - surface.height_m));
  return {c_T - radius_m * normal_T, normal_T, radius_m - height_m};
}

/// Deepest point of a circle in the ground: the lowest point along the normal, iterated with the normal at that point.
Touch touch_rim(const HeightGrid& grid, const Vector3d& c_T, const Vector3d& axis_T, double radius_m) {
  Touch deepest = no_touch();
  Vector3d normal_T = grid.smooth_at(c_T.x(), c_T.y()).normal();
  for (int i = 0; i < 4; ++i) {
    const Vector3d down_T = normal_T.dot(axis_T) * axis_T - normal_T;
    const double length = down_T.norm();
    if (length < 1e-3) break;  // the circle is parallel to the ground: no lowest point
    const Touch touch = touch_at(grid, c_T + radius_m / length * down_T);
    if (touch.depth_m > deepest.depth_m) deepest = touch;
    const bool settled = (touch.normal_T - normal_T).squaredNorm() < 1e-20;
    if (settled || touch.depth_m < -radius_m) break;
    normal_T = touch.normal_T;
  }
  return deepest;
}

/// Adds the contacts of a prism-like shape: both ends, and between them the deepest point where the ground is higher
/// than their line. `at(s)` is the contact at s from -1 to 1.
template <typename At>
void touch_along(const HeightGrid& grid, double length_m, Touches& touches, At&& at) {
  const Touch first = at(-1.0), last = at(1.0);
  touches.add(first);
  touches.add(last);
  // Deepest point above the line between the ends.
  const int between = std::clamp(static_cast<int>(length_m / grid.cell_m), 1, 7);
  Touch deepest = no_touch();
  double max_m = bulge_m;
  for (int i = 1; i <= between; ++i) {
    const double s = 2.0 * i / (between + 1) - 1;
    const Touch touch = at(s);
    const double bulge = touch.depth_m - ((1 - s) * first.depth_m + (1 + s) * last.depth_m) / 2;
    if (!(bulge > max_m)) continue;
    max_m = bulge;
    deepest = touch;
  }
  touches.add(deepest);
}

/// Pose of a shape in the frame of the terrain.
struct Seat {
  Vector3d p_T;
  Matrix3d R_TG;
};

void touch_capsule(const HeightGrid& grid, dGeomID geom, const Seat& seat, Touches& touches) {
  dReal radius_m, length_m;
  dGeomCapsuleGetParams(geom, &radius_m, &length_m);
  const Vector3d half_T = length_m / 2 * seat.R_TG.col(2);
  touch_along(grid, length_m, touches, [&](double s) { return touch_sphere(grid, seat.p_T + s * half_T, radius_m); });
}

void touch_cylinder(const HeightGrid& grid, dGeomID geom, const Seat& seat, Touches& touches) {
  dReal radius_m, length_m;
  dGeomCylinderGetParams(geom, &radius_m, &length_m);
  const Vector3d axis_T = seat.R_TG.col(2);
  const Vector3d half_T = length_m / 2 * axis_T;
  touch_along(grid, length_m, touches,
              [&](double s) { return touch_rim(grid, seat.p_T + s * half_T, axis_T, radius_m); });
  // Axis within 30 degrees of the normal: four points of the lower rim, and the center of the end where the ground is
  // higher.
  const double upright = axis_T.dot(grid.smooth_at(seat.p_T.x(), seat.p_T.y()).normal());
  if (std::abs(upright) < 0.866) return;
  const Vector3d end_T = seat.p_T - std::copysign(1.0, upright) * half_T;
  double rim_m = -1e30;
  for (const int axis : {0, 1})
    for (const double side : {radius_m, -radius_m}) {
      const Touch touch = touch_at(grid, end_T + side * seat.R_TG.col(axis));
      rim_m = std::max(rim_m, touch.depth_m);
      touches.add(touch);
    }
  if (const Touch middle = touch_at(grid, end_T); middle.depth_m > rim_m + bulge_m) touches.add(middle);
}

/// Contacts of a box: its corners, and on the face that points down a grid of points spaced by cells, at most 7 x 7,
/// where the ground is higher than the plane of the corners.
void touch_box(const HeightGrid& grid, dGeomID geom, const Seat& seat, Touches& touches) {
  dVector3 lengths;
  dGeomBoxGetLengths(geom, lengths);
  const Vector3d half(lengths[0] / 2, lengths[1] / 2, lengths[2] / 2);
  const Vector3d down_G = -(seat.R_TG.transpose() * grid.smooth_at(seat.p_T.x(), seat.p_T.y()).normal());
  int k = 0;  // the axis closest to downwards
  down_G.cwiseAbs().maxCoeff(&k);
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  const double bottom = std::copysign(half[k], down_G[k]);
  const auto at = [&](double s, double t, double height) {
    Vector3d p_G;
    p_G[i] = s * half[i];
    p_G[j] = t * half[j];
    p_G[k] = height;
    return touch_at(grid, seat.p_T + seat.R_TG * p_G);
  };
  // Add the corners of the lower and the upper face.
  double corner_m[2][2];
  for (const int s : {0, 1})
    for (const int t : {0, 1}) {
      const Touch corner = at(2 * s - 1, 2 * t - 1, bottom);
      corner_m[s][t] = corner.depth_m;
      touches.add(corner);
      touches.add(at(2 * s - 1, 2 * t - 1, -bottom));
    }
  // Add the points between them where the ground bulges.
  const auto gaps = [&](int axis) {
    return std::clamp(static_cast<int>(std::ceil(2 * half[axis] / grid.cell_m)), 1, 6);
  };
  const int m = gaps(i), n = gaps(j);
  for (int a = 0; a <= m; ++a)
    for (int b = 0; b <= n; ++b) {
      if ((a == 0 || a == m) && (b == 0 || b == n)) continue;
      const double s = static_cast<double>(a) / m, t = static_cast<double>(b) / n;
      const double plane_m = (1 - s) * ((1 - t) * corner_m[0][0] + t * corner_m[0][1]) +
                             s * ((1 - t) * corner_m[1][0] + t * corner_m[1][1]);
      if (const Touch touch = at(2 * s - 1, 2 * t - 1, bottom); touch.depth_m > plane_m + bulge_m) touches.add(touch);
    }
}

void touch_mesh(const CollisionTerrain& terrain, dGeomID geom, const Seat& seat, Touches& touches) {
  const CollisionMesh* mesh = terrain.meshes.find(dGeomTriMeshGetTriMeshDataID(geom));
  if (mesh == nullptr) return;
  for (const Vector3d& p_G : mesh->extremes_m) touches.add(touch_at(terrain.terrain.grid, seat.p_T + seat.R_TG * p_G));
}

}  // namespace

int collide_with_smooth(const CollisionTerrain& terrain, dGeomID o1, dGeomID o2, int flags, dContactGeom* contacts,
                        int skip) {
  const HeightGrid& grid = terrain.terrain.grid;
  // Pose of the shape in the frame of the terrain.
  const Matrix3d R_WT = rotation_to_eigen(dGeomGetRotation(o1));
  const Vector3d p_WT = to_eigen(dGeomGetPosition(o1));
  const Seat seat{R_WT.transpose() * (to_eigen(dGeomGetPosition(o2)) - p_WT),
                  R_WT.transpose() * rotation_to_eigen(dGeomGetRotation(o2))};
  Touches touches;
  switch (dGeomGetClass(o2)) {
    case dSphereClass:
      touches.add(touch_sphere(grid, seat.p_T, dGeomSphereGetRadius(o2)));
      break;
    case dCapsuleClass:
      touch_capsule(grid, o2, seat, touches);
      break;
    case dCylinderClass:
      touch_cylinder(grid, o2, seat, touches);
      break;
    case dBoxClass:
      touch_box(grid, o2, seat, touches);
      break;
    default:
      touch_mesh(terrain, o2, seat, touches);
  }
  // Write the selected contacts in ODE's format.
  const int count = touches.choose(flags & 0xffff);
  for (int i = 0; i < count; ++i) {
    auto& contact =
        *reinterpret_cast<dContactGeom*>(reinterpret_cast<char*>(contacts) + i * static_cast<std::ptrdiff_t>(skip));
    const Vector3d position_W = p_WT + R_WT * touches[i].position_T;
    const Vector3d into_ground_W = -(R_WT * touches[i].normal_T);  // ODE's normals point into the first geom
    for (int axis = 0; axis < 3; ++axis) {
      contact.pos[axis] = position_W[axis];
      contact.normal[axis] = into_ground_W[axis];
    }
    contact.depth = touches[i].depth_m;
    contact.g1 = o1;
    contact.g2 = o2;
    contact.side1 = contact.side2 = -1;
  }
  return count;
}

}  // namespace sim
