// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/hydrodynamics/immersed_piece.hpp"
#include "sim/model/hydrodynamics_config.hpp"

namespace sim {

/// Drag on the pieces of one body in one step.  Forces and torques are about the center of mass, in world axes; a twist
/// is its linear velocity, then its angular velocity.
class ImmersedDrag {
 public:
  /// Starts a new body with this motion, m/s and rad/s.
  void begin(const Matrix3d& R_WB, const Vector3d& v_WC_W, const Vector3d& w_W);
  /// Adds a piece in a fluid.  `share`: fraction of it in the fluid; `at_CP_W`: center of pressure relative to the
  /// center of mass.
  void add(const ImmersedPiece& piece, double share, double density_kgpm3, const Vector3d& v_fluid_W,
           const Vector3d& at_CP_W, const Matrix3d& R_WP);

  /// Sum of the drag with the velocities that begin() got.
  const Vector3d& force_N() const { return force_N_; }
  const Vector3d& torque_Nm() const { return torque_Nm_; }

  /// Whether that drag would be inaccurate: it changes much during the step, or the driving
  /// forces alone would change the velocities by up to `dv_mps` and `dw_radps`.  Inertia and `dw_radps` are about the
  /// body axes.
  bool too_stiff(double mass_kg, const Vector3d& inertia_kgm2, double dv_mps, const Vector3d& dw_radps,
                 double step_s) const;
  /// Backward Euler: returns the acceleration a that solves M a = `other` + drag(twist + h a).  Drag cannot reverse a
  /// motion there, and a driven body approaches its terminal speed from below, for any step length.
  Vector6d acceleration(const Matrix6d& M, const Vector6d& other, double step_s);

 private:
  struct Part {
    const ImmersedPiece* piece;
    Matrix3d R_WP;
    Vector3d at_CP_W, v_fluid_W;
    double pressure;     ///< density / 2 times the fraction in the fluid
    double speed, rate;  ///< factors of the quadratic drag
  };
  void factors(const Part& part, const Vector6d& twist, double& speed, double& rate) const;

  Matrix3d R_WB_;
  Vector6d twist_;
  Vector3d force_N_, torque_Nm_;
  // Bounds of d(drag) / d(velocity), and their growth with speed and rate; for rotation about the body axes.
  double linear_kgps_, linear_kgpm_;
  Vector3d angular_Nms_, angular_by_speed_Ns2_, angular_by_rate_Nms2_;
  Vector3d reach_m_;  ///< distance of the pieces from these axes
  std::vector<Part> parts_;
};

}  // namespace sim
