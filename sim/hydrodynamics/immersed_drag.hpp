// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/hydrodynamics/immersed_piece.hpp"
#include "sim/model/hydrodynamics_config.hpp"

namespace sim {

/// Drag on the pieces of one body in one step.  Forces and torques are about the centre of mass, in the world's axes;
/// twists are its velocity, then the angular one.
class ImmersedDrag {
 public:
  /// For a body that moves like this, m/s and rad/s.
  void begin(const Matrix3d& R_WB, const Vector3d& v_WC_W, const Vector3d& w_W);
  /// A piece in a fluid.  `share`: how much of it the fluid reaches; `at_CP_W`: where the pressure acts.
  void add(const ImmersedPiece& piece, double share, double density_kgpm3, const Vector3d& v_fluid_W,
           const Vector3d& at_CP_W, const Matrix3d& R_WP);

  /// With the velocities at the start of the step.
  const Vector3d& force_N() const { return force_N_; }
  const Vector3d& torque_Nm() const { return torque_Nm_; }

  /// True when the drag at the start of the step would be inaccurate: drag changes much during the step, or what drives
  /// the body would have changed its velocities by up to `dv_mps` and `dw_radps` without drag.  Inertia and `dw_radps`
  /// are about the axes of the body.
  bool too_stiff(double mass_kg, const Vector3d& inertia_kgm2, double dv_mps, const Vector3d& dw_radps,
                 double step_s) const;
  /// Backward Euler: the acceleration a that solves M a = `other` + drag(twist + h a).  Drag cannot reverse a motion
  /// there, and a driven body approaches its terminal speed from below, for any step length.
  Vector6d acceleration(const Matrix6d& M, const Vector6d& other, double step_s);

 private:
  struct Part {
    const ImmersedPiece* piece;
    Matrix3d R_WP;
    Vector3d at_CP_W, v_fluid_W;
    double pressure;     ///< density / 2, of what the fluid reaches
    double speed, rate;  ///< the factors that make drag quadratic
  };
  void factors(const Part& part, const Vector6d& twist, double& speed, double& rate) const;

  Matrix3d R_WB_;
  Vector6d twist_;
  Vector3d force_N_, torque_Nm_;
  // Bounds of d(drag) / d(velocity), and how they grow with the speed and the rate; of rotation about the axes of the
  // body.
  double linear_kgps_, linear_kgpm_;
  Vector3d angular_Nms_, angular_by_speed_Ns2_, angular_by_rate_Nms2_;
  Vector3d reach_m_;  ///< of the pieces from these axes
  std::vector<Part> parts_;
};

}  // namespace sim
