// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/hydrodynamics/immersed_volume.hpp"
#include "sim/model/physics_config.hpp"

namespace sim {

/// A part in the water, or one of the sections that a long part is cut into so that waves shorter than it count.
struct ImmersedPiece {
  enum class Shape { sphere, box, round, mesh };

  Shape shape = Shape::box;
  Matrix3d R_BP = Matrix3d::Identity();              ///< frame P of the piece in the body
  Vector3d p_BP = Vector3d::Zero();                  ///< its origin, near the middle of the piece
  Vector3d size_m = Vector3d::Zero();                ///< extents along the axes of P
  RoundSolid round;                                  ///< shape round; relative to P
  std::shared_ptr<const Mesh> mesh;                  ///< shape mesh; relative to P
  double radius_m = 0;                               ///< about the origin of P: nothing of the piece is farther away
  ImmersedVolume whole;                              ///< wholly under water
  Vector3d drag_area_m2 = Vector3d::Zero();          ///< coefficient times projected area, along x, y and z
  Vector3d angular_drag_area_m5 = Vector3d::Zero();  ///< the same for rotation: torque / (density / 2 rate^2)
  double added_mass_coefficient = 0;

  ImmersedVolume immersed(const WaterPlane& plane) const;
};

/// Meshes are loaded and cut once, however many parts use them.
using PieceMeshes = std::map<std::pair<std::string, double>, std::shared_ptr<const Mesh>>;

/// The pieces of a part; none for one that displaces nothing.  What is longer than `max_m` is cut across its
/// longest axis, into 8 at most; a sphere never is.  An open mesh displaces nothing, which `warning` reports;
/// ConfigError when the part sets `displaces`.
std::vector<ImmersedPiece> pieces_of(const PartConfig& part, double max_m, const std::string& who, PieceMeshes& meshes,
                                     std::optional<std::string>& warning);

}  // namespace sim
