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

/// Part in the water, or one section of a long part, cut so that short waves are resolved.
struct ImmersedPiece {
  enum class Shape { sphere, box, round, mesh };

  Shape shape = Shape::box;
  Matrix3d R_BP = Matrix3d::Identity();              ///< frame P of the piece in the body
  Vector3d p_BP = Vector3d::Zero();                  ///< origin of P, near the center of the piece
  Vector3d size_m = Vector3d::Zero();                ///< extents along the axes of P
  RoundSolid round;                                  ///< shape round; relative to P
  std::shared_ptr<const Mesh> mesh;                  ///< shape mesh; relative to P
  double radius_m = 0;                               ///< bounding radius about the origin of P
  ImmersedVolume whole;                              ///< volume when fully submerged
  Vector3d drag_area_m2 = Vector3d::Zero();          ///< coefficient times projected area, along x, y and z
  Vector3d angular_drag_area_m5 = Vector3d::Zero();  ///< the same for rotation: torque / (density / 2 rate^2)
  double added_mass_coefficient = 0;

  ImmersedVolume immersed(const WaterPlane& plane) const;
};

/// Cache of meshes, loaded once for all parts that use them.
using PieceMeshes = std::map<std::pair<std::string, double>, std::shared_ptr<const Mesh>>;

/// Returns the pieces of a part; none for a part that displaces no water.  A part longer than `max_m` is cut across its
/// longest axis, into at most 8 sections; a sphere is never cut.  An open mesh displaces no water, with a text in
/// `warning`, without `who`; ConfigError when the part sets `displaces`.
std::vector<ImmersedPiece> pieces_of(const PartConfig& part, double max_m, const std::string& who, PieceMeshes& meshes,
                                     std::optional<std::string>& warning);

}  // namespace sim
