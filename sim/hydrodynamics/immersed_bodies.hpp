// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/base/thread_pool.hpp"
#include "sim/config/warnings.hpp"
#include "sim/hydrodynamics/immersed_drag.hpp"
#include "sim/hydrodynamics/immersed_piece.hpp"
#include "sim/medium/medium.hpp"
#include "sim/physics/body.hpp"

namespace sim {

/// Motion of a body and of the surrounding water in a step, where forces act: Body::motion_for_forces().
struct BodyInWater {
  LocalWater water;                 ///< at the origin of the body
  BodyMotion motion;                ///< half a step after its start for a body that is alone
  Vector3d v_B = Vector3d::Zero();  ///< velocity of the origin relative to the water, in body axes
  Vector3d w_B = Vector3d::Zero();  ///< angular velocity of the body, in body axes
  bool known = false;  ///< false: hydrodynamics do not apply to this body, and the other members are unused
};

/// Buoyancy and drag of free bodies without hydrodynamic coefficients, part by part.  docs/models/marine.md has the
/// model.
class ImmersedBodies {
 public:
  ImmersedBodies(const Medium& medium, double step_s) : medium_(medium), step_s_(step_s) {}

  /// Adds a body and returns its bounding radius about the origin, m; 0 for a body without displacing parts, which is
  /// not added.  Appends warnings about it.  Throws ConfigError (meshes).
  double add(Body& body, const BodyConfig& config, double gravity_mps2, std::vector<Warning>& warnings);
  void remove_group(int group);
  /// Adds the water forces to the forces on each body.  `around`: by body number.  `threads` may be null.
  void step(double gravity_mps2, std::span<const BodyInWater> around, ThreadPool* threads);

 private:
  /// Data of a body for each step.
  struct ImmersedBody {
    Body* body = nullptr;
    double radius_m = 0;  ///< bounding radius about the origin of the body
    // Hydrostatic stiffness that is too high for the step, see find_stiffness(); 0: none.
    bool stiff = false;
    double stiff_Npm = 0;
    Vector3d stiff_Nmprad = Vector3d::Zero();  ///< about the axes of the body
    std::vector<ImmersedPiece> pieces;
  };
  struct Wrench;

  std::vector<ImmersedPiece> pieces_of(const Body& body, const BodyConfig& config, double max_m,
                                       std::vector<Warning>& warnings);
  void find_stiffness(ImmersedBody& body, const SourcePlace& place, double gravity_mps2,
                      std::vector<Warning>& warnings) const;
  // `drag`: of the present body.
  void step_body(const ImmersedBody& body, double gravity_mps2, const BodyInWater& around, ImmersedDrag& drag) const;
  void add_piece(const ImmersedPiece& piece, double gravity_mps2, const LocalWater& at_origin, ImmersedDrag& drag,
                 Wrench& sum) const;
  WaterPlane surface_at(const ImmersedPiece& piece, const Vector3d& p_WP, const LocalWater& water) const;
  void add_stiffness(const ImmersedBody& body, const LocalWater& water, Wrench& sum) const;
  bool apply(Body& body, double gravity_mps2, ImmersedDrag& drag, const Wrench& sum) const;
  void add_wind(const ImmersedBody& body, ImmersedDrag& drag, const Wrench& sum) const;

  const Medium& medium_;
  double step_s_;
  std::vector<ImmersedBody> bodies_;  // in order of addition
  PieceMeshes meshes_;
};

}  // namespace sim
