// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/base/math.hpp"
#include "sim/geometry/mesh.hpp"

namespace sim {

/// The surface of the water as a plane in the frame of a solid: what has normal . p < level is under water.
struct WaterPlane {
  Vector3d normal = Vector3d::UnitZ();  ///< of length 1, out of the water
  double level_m = 0;                   ///< of the plane over the origin, along the normal
};

/// The part of a solid that is under water, in the frame of the solid.
struct ImmersedVolume {
  double volume_m3 = 0;
  Vector3d centroid_m = Vector3d::Zero();  ///< zero when nothing is under water
};

/// A cylinder or capsule along z, its centre at the origin, or what of it lies between two heights.
struct RoundSolid {
  double radius_m = 0.5;
  double half_length_m = 0.5;  ///< of a capsule without its caps
  bool capped = false;         ///< a capsule
  double low_m = -0.5;         ///< z of its lower end, at least -half_length_m, for a capsule with the cap
  double high_m = 0.5;
};

/// A sphere about the origin.  Closed form.
ImmersedVolume immersed_sphere(double radius_m, const WaterPlane& plane);
/// A box about the origin.  Exact: its faces are clipped by the plane.
ImmersedVolume immersed_box(const Vector3d& size_m, const WaterPlane& plane);
/// Sums circular segments along the axis by Gauss' rule between the places where the surface enters and leaves the
/// solid; relative error below 1e-5.  Exact for an axis along or across the plane.
ImmersedVolume immersed_round(const RoundSolid& solid, const WaterPlane& plane);
/// A closed mesh, counter-clockwise seen from outside.  Exact: its triangles are clipped by the plane.
ImmersedVolume immersed_mesh(const Mesh& mesh, const WaterPlane& plane);

/// What of a closed mesh lies between two heights along an axis (0: x, 1: y, 2: z), closed again.  The faces that
/// close it may overlap each other with opposite signs, which volumes and moments do not mind.
Mesh section_of(const Mesh& mesh, int axis, double low_m, double high_m);

}  // namespace sim
