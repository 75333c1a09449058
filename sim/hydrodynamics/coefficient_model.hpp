// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "sim/base/math.hpp"
#include "sim/medium/medium.hpp"
#include "sim/model/hydrodynamics_config.hpp"

namespace sim {

/// State of a craft relative to the water, in forward-right-down axes.
struct CraftState {
  Vector6d nu;                        ///< velocity over ground of the origin, then angular velocity; m/s, rad/s
  Vector3d v_water;                   ///< of the water at the origin, m/s
  Vector3d v_air = Vector3d::Zero();  ///< of the wind, m/s; used with windage only
  Vector3d a_water;                   ///< acceleration of the water in waves, m/s^2
  Vector3d down;                      ///< unit vector towards the center of the earth
  double depth_m = 0;                 ///< of the origin below the surface
  double surface_roll_rad = 0, surface_pitch_rad = 0;  ///< slope of the surface at its water plane
  double density_kgpm3 = 0;                            ///< of the water
};

/// Force and torque, or linear and angular velocity.  Apart, because a packet of both would wait for numbers that were
/// written one by one.
struct Six {
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();

  Six() = default;
  explicit Six(const Vector6d& all) : linear(all[0], all[1], all[2]), angular(all[3], all[4], all[5]) {}
  void copy_to(Vector6d& all) const { all << linear, angular; }
  double& operator[](int i) { return i < 3 ? linear[i] : angular[i - 3]; }
  double operator[](int i) const { return i < 3 ? linear[i] : angular[i - 3]; }
};

/// Integrals of 1, x, x^2 and x^3 over a piece of the hull, for cross flow.
struct StripWeights {
  double d1 = 0, d2 = 0, d3 = 0, d4 = 0;
  StripWeights() = default;
  StripWeights(double from, double to)
      : d1(to - from),
        d2((to * to - from * from) / 2),
        d3((to * to * to - from * from * from) / 3),
        d4((to * to * to * to - from * from * from * from) / 4) {}
};

/// Equations of motion of a marine craft (Fossen 2011, eq. 8.1 to 8.8 in relative velocity): rigid-body and added mass,
/// Coriolis forces of both, damping, restoring forces.  All in forward-right-down axes about the origin of the body.
/// The model has no state, so that identical vehicles share one.
class CoefficientModel {
 public:
  CoefficientModel(const HydrodynamicsConfig& config, double gravity_mps2);

  /// Returns d(nu)/dt under the forces `tau` (N, N m about the origin), which exclude those of the water, weight and
  /// buoyancy.
  Vector6d acceleration(const CraftState& state, const Vector6d& tau) const;
  /// The same for a step that is too long for this velocity: damping is linearized and evaluated at the end of the step
  /// (backward Euler), and Coriolis forces add no energy, so that the motion is stable at any speed.
  Vector6d stiff_acceleration(const CraftState& state, const Vector6d& tau, double step_s) const;
  /// Returns the hydrodynamic forces except those proportional to acceleration, plus weight and buoyancy.
  Vector6d forces(const CraftState& state, const Vector6d& nu_r) const;

  /// Returns the wrench about the center of mass, in these axes, that gives this acceleration to a body of mass
  /// `mass_kg` and inertia `inertia` about its center of mass.
  Vector6d equivalent_wrench(const Vector6d& nu_dot, const Vector3d& v, const Vector3d& w, double mass_kg,
                             const Matrix3d& inertia) const;

  const HydrodynamicsConfig& config() const { return config_; }
  bool current_by_yaw_only() const { return current_by_yaw_only_; }
  const Matrix6d& mass() const { return mass_; }  ///< rigid-body and added mass
  double weight_N() const { return weight_N_; }
  double buoyancy_N() const { return buoyancy_N_; }

  /// Largest step that resolves linear damping and restoring forces (2 over the fastest rate), and the forces that
  /// limit it.
  struct StepLimit {
    double step_s;
    const char* why;
  };
  StepLimit max_step() const;
  /// Fastest rate of damping or Coriolis forces at this velocity relative to the water, 1/s.  An explicit step must be
  /// shorter than its inverse.
  double fastest_rate(const Six& nu_r) const {
    const auto fastest = [](const auto& linear, const auto& quadratic, const Vector3d& v) {
      return (linear + quadratic.cwiseProduct(v.cwiseAbs())).maxCoeff();
    };
    return std::max({fastest(linear_rate_.head<3>(), quadratic_rate_.head<3>(), nu_r.linear),
                     fastest(linear_rate_.tail<3>(), quadratic_rate_.tail<3>(), nu_r.angular), turning_rate(nu_r)});
  }

  /// Submerged fraction of the hull, 0 to 1.
  double immersed(const CraftState& state) const;

 private:
  using Coriolis = PublishedQuirks::Coriolis;
  /// Functions with `share`: submerged fraction, as by immersed().  Sum of all forces.
  Six total_forces(const CraftState& state, const Six& tau, const Six& nu_r, double share) const;
  Six forces(const CraftState& state, const Six& nu_r, double share) const;
  Vector3d water_turning(const CraftState& state) const;
  /// Damping forces of a fully submerged craft.
  Six damping(const CraftState& state, const Six& nu_r) const;
  void add_cross_flow(const Six& nu_r, double density, Six& tau) const;
  void add_hull_lift(const Six& nu_r, double density, Six& tau) const;
  void add_windage(const CraftState& state, Six& tau) const;
  void add_restoring(const CraftState& state, double share, Six& tau) const;
  /// Drag coefficient of the cross flow at this speed, from the table over the Reynolds number.
  double cross_flow_drag(double speed) const;
  double displaced_kg(const CraftState& state) const;
  void fold_derivatives();
  void find_rates();
  void find_turning();
  double turning_rate(const Six& nu_r) const {
    return std::max(spin_ratio_ * nu_r.angular.norm(), munk_radpm_ * nu_r.linear.norm());
  }

  HydrodynamicsConfig config_;
  double gravity_mps2_;
  Matrix6d mass_;
  Matrix6d mass_inverse_;
  double weight_N_, buoyancy_N_, height_m_;
  Vector6d linear_diagonal_, quadratic_diagonal_;
  Vector6d linear_rate_, quadratic_rate_;  // damping over mass, per axis
  StripWeights whole_hull_;                // of cross flow
  double spin_ratio_ = 1;                  // rate of Coriolis forces over the angular velocity
  double munk_radpm_ = 0;                  // angular frequency due to the Munk moment over the speed
  bool diagonal_damping_;
  bool added_mass_is_diagonal_;
  Coriolis coriolis_;
  bool current_by_yaw_only_, fade_by_speed_in_water_;
};

}  // namespace sim
