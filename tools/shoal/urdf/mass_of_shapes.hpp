// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

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

}  // namespace tools
