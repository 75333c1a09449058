// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "sim/geometry/mesh.hpp"
#include "tools/shoal/urdf/imported_meshes.hpp"

namespace tools {

/// Density of a body whose inertia is not known and that has no shapes.
inline constexpr double usual_density_kgpm3 = 1000;

/// Gives bodies that lack it a mass or an inertia, that of a solid of the body's shapes: of those that collide, else of
/// the visual ones, each mesh as its convex hull; overlaps count twice.  A body without mass gets the density, another
/// one keeps mass and center of mass.  A body without shapes becomes a ball: of 10 mm radius, or with its mass.  Each
/// gets a note.  `meshes`: those that convert_meshes() returned.
void complete_masses(ImportedVehicle& vehicle, const std::vector<MeshFile>& meshes,
                     double density_kgpm3 = usual_density_kgpm3);

/// Solid of the parts of a body that collide, in its frame; volume 0: there are none.  A mesh counts as its hull.
sim::MeshSolid collision_solid(const ImportedBody& body, const std::vector<MeshFile>& meshes);

/// Solid of a shape in its own frame; nothing for a mesh.
std::optional<sim::MeshSolid> solid_of_shape(const RobotShape& shape);

/// Returns the points that lie outermost in 256 directions, spread evenly (Fibonacci lattice), and along the axes.
/// The hull has the bounding box of all points.
std::vector<sim::Vector3d> outermost_points(const std::vector<sim::Vector3d>& points);

/// Returns the convex hull as a closed mesh that faces outwards, by insertion of one point after the other: time grows
/// with the square of their number.  std::nullopt when the points lie in one plane.
std::optional<sim::Mesh> convex_hull(const std::vector<sim::Vector3d>& points);

}  // namespace tools
