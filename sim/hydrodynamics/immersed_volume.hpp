// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/base/math.hpp"
#include "sim/geometry/mesh.hpp"

namespace sim {

/// Water surface as a plane in the frame of a solid: points with normal . p < level are under water.
struct WaterPlane {
  Vector3d normal = Vector3d::UnitZ();  ///< unit vector, out of the water
  double level_m = 0;                   ///< distance of the plane from the origin, along the normal
};

/// Submerged part of a solid, in the frame of the solid.
struct ImmersedVolume {
  double volume_m3 = 0;
  Vector3d centroid_m = Vector3d::Zero();  ///< zero when the volume is zero
};

/// Cylinder or capsule along z with its center at the origin, or its part between two heights.
struct RoundSolid {
  double radius_m = 0.5;
  double half_length_m = 0.5;  ///< of a capsule without its caps
  bool capped = false;         ///< a capsule
  double low_m = -0.5;         ///< z of its lower end, at least -half_length_m, for a capsule with the cap
  double high_m = 0.5;
};

/// Submerged volume of a sphere about the origin, in closed form.
ImmersedVolume immersed_sphere(double radius_m, const WaterPlane& plane);
/// Submerged volume of a box about the origin.  Exact: its faces are clipped by the plane.
ImmersedVolume immersed_box(const Vector3d& size_m, const WaterPlane& plane);
/// Submerged volume of a cylinder or capsule: circular segments, summed along the axis by Gauss quadrature between the
/// points where the surface enters and leaves the solid; relative error below 1e-5.  Exact for an axis along or across
/// the plane.
ImmersedVolume immersed_round(const RoundSolid& solid, const WaterPlane& plane);
/// Submerged volume of a closed mesh, counter-clockwise seen from outside.  Exact: its triangles are clipped by the
/// plane.
ImmersedVolume immersed_mesh(const Mesh& mesh, const WaterPlane& plane);

/// Part of a closed mesh between two heights along an axis (0: x, 1: y, 2: z), closed again.  The closing faces may
/// overlap each other with opposite signs, which does not affect volumes and moments.
Mesh section_of(const Mesh& mesh, int axis, double low_m, double high_m);

}  // namespace sim
