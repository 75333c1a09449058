// SPDX-License-Identifier: BSD-3-Clause
#include "sim/hydrodynamics/level_speed.hpp"

#include <limits>

namespace sim {

namespace {

/// Returns the force and torque of water, weight and buoyancy in forward-right-down axes.
Vector6d force_in(const CoefficientModel& model, LevelMotion motion, double speed_mps, double tilt_rad) {
  const bool ahead = motion == LevelMotion::ahead;
  const Matrix3d R_VW = Eigen::AngleAxisd(-tilt_rad, ahead ? Vector3d::UnitY() : Vector3d::UnitX()).toRotationMatrix();
  CraftState state;
  state.nu.setZero();
  state.nu.head<3>() = speed_mps * R_VW.col(ahead ? 0 : 1);
  state.v_water = state.a_water = Vector3d::Zero();
  state.down = R_VW.col(2);
  state.depth_m = 1000;
  state.density_kgpm3 = 1025;
  return model.mass() * model.acceleration(state, Vector6d::Zero());
}

}  // namespace

double level_drag_N(const CoefficientModel& model, LevelMotion motion, double speed_mps) {
  return -force_in(model, motion, speed_mps, 0)[motion == LevelMotion::ahead ? 0 : 1];
}

double righting_Nmprad(const CoefficientModel& model, LevelMotion motion, double speed_mps) {
  constexpr double tilt_rad = 1e-3;
  const int torque = motion == LevelMotion::ahead ? 4 : 3;
  return (force_in(model, motion, speed_mps, -tilt_rad)[torque] -
          force_in(model, motion, speed_mps, tilt_rad)[torque]) /
         (2 * tilt_rad);
}

double tipping_mps(const CoefficientModel& model, LevelMotion motion, double held_Nmprad) {
  constexpr double fastest_mps = 20;
  const double tipping = last_where(
      0, fastest_mps, [&](double speed_mps) { return righting_Nmprad(model, motion, speed_mps) + held_Nmprad > 0; });
  return tipping < fastest_mps ? tipping : std::numeric_limits<double>::infinity();
}

}  // namespace sim
