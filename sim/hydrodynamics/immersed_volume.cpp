// SPDX-License-Identifier: BSD-3-Clause
#include "sim/hydrodynamics/immersed_volume.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sim {

namespace {

/// Sums the tetrahedra between the submerged faces of a closed surface and a point of the water plane; those of the
/// water plane itself have no volume.  The sum is the submerged volume (divergence theorem).
class WetFaces {
 public:
  explicit WetFaces(const WaterPlane& plane) : plane_(plane), apex_(plane.level_m * plane.normal) {}

  /// Adds a convex face of three or four corners, counter-clockwise seen from outside.
  template <std::size_t n>
  void add(const std::array<Vector3d, n>& corners) {
    // Depths of the corners.
    std::array<double, n> depth;
    bool all = true, none = true;
    for (std::size_t i = 0; i < n; ++i) {
      depth[i] = plane_.level_m - plane_.normal.dot(corners[i]);
      all &= depth[i] >= 0;
      none &= depth[i] <= 0;
    }
    if (none) return;
    // Clip the face at the water plane.
    std::array<Vector3d, n + 2> wet;
    std::size_t count = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t next = i + 1 < n ? i + 1 : 0;
      if (depth[i] >= 0) wet[count++] = corners[i] - apex_;
      if (!all && (depth[i] > 0) != (depth[next] > 0) && depth[i] != 0 && depth[next] != 0) {
        const double share = depth[i] / (depth[i] - depth[next]);
        wet[count++] = corners[i] + share * (corners[next] - corners[i]) - apex_;
      }
    }
    for (std::size_t i = 2; i < count; ++i) {
      // Tetrahedron from the apex to a triangle of the clipped face.
      const double det = wet[0].dot(wet[i - 1].cross(wet[i]));
      volume_ += det / 6;
      first_ += det / 24 * (wet[0] + wet[i - 1] + wet[i]);
    }
  }

  ImmersedVolume sum() const {
    if (!(volume_ > 0)) return {};
    return {volume_, apex_ + first_ / volume_};
  }

 private:
  WaterPlane plane_;
  Vector3d apex_;
  double volume_ = 0;
  Vector3d first_ = Vector3d::Zero();
};

}  // namespace

ImmersedVolume immersed_sphere(double radius_m, const WaterPlane& plane) {
  // Spherical cap: volume and centroid.
  const double height = std::clamp(radius_m + plane.level_m, 0.0, 2 * radius_m);  // of the cap under water
  if (height == 0) return {};
  const double volume = std::numbers::pi * height * height * (3 * radius_m - height) / 3;
  const double rest = 2 * radius_m - height;
  const double below = 3 * rest * rest / (4 * (3 * radius_m - height));
  return {volume, -below * plane.normal};
}

ImmersedVolume immersed_box(const Vector3d& size_m, const WaterPlane& plane) {
  const Vector3d half = size_m / 2;
  const double reach = plane.normal.cwiseAbs().dot(half);
  if (plane.level_m <= -reach) return {};
  if (plane.level_m >= reach) return {size_m.prod(), Vector3d::Zero()};
  WetFaces faces(plane);
  const auto corner = [&](int axis, double a, double b, double c) {
    Vector3d p;
    p[axis] = a * half[axis];
    p[(axis + 1) % 3] = b * half[(axis + 1) % 3];
    p[(axis + 2) % 3] = c * half[(axis + 2) % 3];
    return p;
  };
  // By the divergence theorem the volume under the plane follows from the wet parts of the six faces.
  for (int axis = 0; axis < 3; ++axis) {
    faces.add<4>({corner(axis, 1, -1, -1), corner(axis, 1, 1, -1), corner(axis, 1, 1, 1), corner(axis, 1, -1, 1)});
    faces.add<4>({corner(axis, -1, -1, -1), corner(axis, -1, -1, 1), corner(axis, -1, 1, 1), corner(axis, -1, 1, -1)});
  }
  return faces.sum();
}

ImmersedVolume immersed_mesh(const Mesh& mesh, const WaterPlane& plane) {
  WetFaces faces(plane);
  for (const auto& t : mesh.triangles)
    faces.add<3>({mesh.vertices_m[t[0]], mesh.vertices_m[t[1]], mesh.vertices_m[t[2]]});
  return faces.sum();
}

namespace {

/// Volume and first moments of slices across the axis of a round solid.
class RoundSum {
 public:
  RoundSum(const RoundSolid& solid, const WaterPlane& plane)
      : radius_(solid.radius_m),
        along_(plane.normal.z()),
        across_(std::hypot(plane.normal.x(), plane.normal.y())),
        level_(plane.level_m) {
    if (across_ > 0) direction_ = Vector3d(plane.normal.x(), plane.normal.y(), 0) / across_;
  }

  /// Adds a stretch of the cylinder.
  void add_cylinder(double low, double high) {
    if (!(high > low)) return;
    center_ = 0;
    cap_ = false;
    double cuts[2];
    int count = 0;
    if (along_ != 0)
      for (const double side : {-1.0, 1.0}) cuts[count++] = (level_ - side * radius_ * across_) / along_;
    add_between(low, high, cuts, count);
  }
  /// Adds a stretch of the sphere about (0, 0, center).
  void add_sphere(double low, double high, double center) {
    if (!(high > low)) return;
    center_ = center;
    cap_ = true;
    double cuts[2];
    int count = 0;
    const double level = level_ - along_ * center;  // over the center
    if (std::abs(level) < radius_) {
      const double half = across_ * std::sqrt(radius_ * radius_ - level * level);
      cuts[count++] = center + level * along_ - half;
      cuts[count++] = center + level * along_ + half;
    }
    add_between(low, high, cuts, count);
  }

  ImmersedVolume sum() const {
    if (!(volume_ > 0)) return {};
    Vector3d centroid = moment_across_ / volume_ * direction_;
    centroid.z() = moment_along_ / volume_;
    return {volume_, centroid};
  }

 private:
  double radius_at(double z) const {
    if (!cap_) return radius_;
    return std::sqrt(std::max(0.0, radius_ * radius_ - (z - center_) * (z - center_)));
  }

  void add_between(double low, double high, double* cuts, int count) {
    if (count == 2 && cuts[0] > cuts[1]) std::swap(cuts[0], cuts[1]);
    double from = low;
    for (int i = 0; i < count; ++i) {
      if (!(cuts[i] > from && cuts[i] < high)) continue;
      add_stretch(from, cuts[i]);
      from = cuts[i];
    }
    add_stretch(from, high);
  }

  /// Adds a stretch that is entirely under water, entirely above it, or cut over its whole length.
  void add_stretch(double low, double high) {
    const double middle = (low + high) / 2;
    const double over = level_ - along_ * middle;  // height of the surface over the axis, times `across`
    const double radius = radius_at(middle);
    if (over <= -radius * across_) return;
    if (over >= radius * across_)
      add_whole(low, high);
    else
      add_segments(low, high);
  }

  void add_whole(double low, double high) {
    double volume = std::numbers::pi * radius_ * radius_ * (high - low);
    double moment = volume * (low + high) / 2;
    // Without the cap that stays dry: the integrals of x^2 and of x^3 over the cut.
    if (cap_) {
      const double a = low - center_, b = high - center_;
      const double cut = std::numbers::pi * (b * b * b - a * a * a) / 3;
      volume -= cut;
      moment = volume * center_ +
               std::numbers::pi * (radius_ * radius_ * (b * b - a * a) / 2 - (b * b * b * b - a * a * a * a) / 4);
    }
    volume_ += volume;
    moment_along_ += moment;
  }

  void add_segments(double low, double high) {
    // Gauss-Legendre quadrature, 8 points on [0, 1].  The area of a segment grows with the power 3/2 where the surface
    // reaches the solid; with z a smooth step of u, the integrand in u is not singular.
    static constexpr double at[4] = {0.019855071751231912, 0.10166676129318664, 0.2372337950418355, 0.4082826787521751};
    static constexpr double weight[4] = {0.05061426814518813, 0.11119051722668724, 0.15685332293894363,
                                         0.18134189168918100};
    for (int i = 0; i < 8; ++i) {
      const double u = i < 4 ? at[i] : 1 - at[7 - i];
      const double w = weight[i < 4 ? i : 7 - i] * 6 * u * (1 - u) * (high - low);
      add_slice(low + (high - low) * u * u * (3 - 2 * u), w);
    }
  }

  void add_slice(double z, double thickness) {
    const double radius = radius_at(z);
    if (radius == 0) return;
    const double over = std::clamp((level_ - along_ * z) / (across_ * radius), -1.0, 1.0);
    const double half_chord = std::sqrt(1 - over * over);
    const double area = radius * radius * (std::acos(-over) + over * half_chord);
    volume_ += thickness * area;
    moment_along_ += thickness * area * z;
    moment_across_ -= thickness * 2 / 3 * std::pow(radius * half_chord, 3);
  }

  double radius_, along_, across_, level_;
  Vector3d direction_ = Vector3d::Zero();
  double center_ = 0;
  bool cap_ = false;
  double volume_ = 0, moment_along_ = 0, moment_across_ = 0;
};

}  // namespace

ImmersedVolume immersed_round(const RoundSolid& solid, const WaterPlane& plane) {
  RoundSum sum(solid, plane);
  const double end = solid.half_length_m;
  if (!solid.capped) {
    sum.add_cylinder(solid.low_m, solid.high_m);
    return sum.sum();
  }
  sum.add_sphere(solid.low_m, std::min(-end, solid.high_m), -end);
  sum.add_cylinder(std::max(-end, solid.low_m), std::min(end, solid.high_m));
  sum.add_sphere(std::max(end, solid.low_m), solid.high_m, end);
  return sum.sum();
}

namespace {

/// Keeps the lower side (side 1) or the upper side (side -1) of a plane across an axis, and closes the mesh.
Mesh cut(const Mesh& mesh, int axis, double at_m, double side) {
  Mesh kept;
  const auto add_vertex = [&](const Vector3d& p) {
    kept.vertices_m.push_back(p);
    return static_cast<std::uint32_t>(kept.vertices_m.size() - 1);
  };
  // Each edge along the cut makes a triangle with one point of the cut; the areas outside the solid cancel.
  const std::uint32_t hub = 0;
  bool has_hub = false;
  kept.vertices_m.emplace_back(Vector3d::Zero());
  for (const auto& t : mesh.triangles) {
    // Clip the triangle.
    std::array<std::uint32_t, 4> wet{};
    std::array<bool, 4> on_cut{};
    std::size_t count = 0;
    for (int k = 0; k < 3; ++k) {
      const Vector3d &p = mesh.vertices_m[t[k]], &q = mesh.vertices_m[t[(k + 1) % 3]];
      const double inside = side * (at_m - p[axis]), next = side * (at_m - q[axis]);
      if (inside > 0) wet[count++] = add_vertex(p);
      if ((inside > 0) == (next > 0)) continue;
      Vector3d crossing = p + inside / (inside - next) * (q - p);
      crossing[axis] = at_m;
      if (!has_hub) kept.vertices_m[hub] = crossing;
      has_hub = true;
      on_cut[count] = true;
      wet[count++] = add_vertex(crossing);
    }
    // Add the clipped face, and the closing triangle.
    for (std::size_t i = 2; i < count; ++i) kept.triangles.push_back({wet[0], wet[i - 1], wet[i]});
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t next = (i + 1) % count;
      if (on_cut[i] && on_cut[next]) kept.triangles.push_back({hub, wet[next], wet[i]});
    }
  }
  if (!has_hub && kept.vertices_m.size() > 1) kept.vertices_m[hub] = kept.vertices_m[1];  // no triangle was cut
  return kept;
}

}  // namespace

Mesh section_of(const Mesh& mesh, int axis, double low_m, double high_m) {
  return cut(cut(mesh, axis, high_m, 1), axis, low_m, -1);
}

}  // namespace sim
