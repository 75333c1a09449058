// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/physics/body.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/world/world.hpp"

namespace devices {

/// State of a device frame D in the water.
struct WaterFlow {
  sim::BodyMotion body;
  sim::Vector3d p_WD;        ///< origin of the device frame
  sim::Vector3d v_B;         ///< its velocity through the water, in axes of the body, m/s
  sim::Vector3d water_W;     ///< velocity of the water at the body, m/s
  double depth_m = 0;        ///< depth of the origin below the surface
  double density_kgpm3 = 0;  ///< density of the water; 0 in a world without water
};

/// Mounting of an actuator on a body in the water: provides the flow at the device and applies its forces.
class WaterMount {
 public:
  explicit WaterMount(const sim::DeviceContext& context)
      : world_(context.world),
        body_(context.body),
        p_BD_(context.config.X_BS().translation()),
        p_CD_(p_BD_ - body_.p_BC()),
        R_BD_(context.config.X_BS().linear()),
        turned_(!R_BD_.isIdentity(0)),
        mass_at_D_kg_(mass_at(body_, p_BD_)) {}

  /// Returns the flow where forces act in this step.
  WaterFlow flow() const {
    WaterFlow flow;
    const sim::BodyInWater& around = world_.hydrodynamics().around(body_);
    if (!around.known) return flow_without_cache();
    flow.body = around.motion;
    flow.p_WD = around.motion.p_WB + around.motion.R_WB * p_BD_;
    flow.density_kgpm3 = around.water.density_kgpm3;
    flow.depth_m = around.water.surface_m - flow.p_WD.z();
    flow.water_W = around.water.velocity_W;
    flow.v_B = around.v_B + around.w_B.cross(p_BD_);
    return flow;
  }
  /// Returns the velocity of D through the water, in D, m/s.
  sim::Vector3d v_D(const WaterFlow& flow) const {
    return turned_ ? sim::Vector3d(R_BD_.transpose() * flow.v_B) : flow.v_B;
  }
  /// Rotates a vector from W to D.
  sim::Vector3d in_D(const WaterFlow& flow, const sim::Vector3d& v_W) const {
    const sim::Vector3d v_B = flow.body.R_WB.transpose() * v_W;
    return turned_ ? sim::Vector3d(R_BD_.transpose() * v_B) : v_B;
  }
  /// Rotates a vector from D to W.
  sim::Vector3d in_W(const WaterFlow& flow, const sim::Vector3d& v_D) const {
    const sim::Vector3d v_B = turned_ ? sim::Vector3d(R_BD_ * v_D) : v_D;
    return flow.body.R_WB * v_B;
  }
  /// Returns the force that stops the relative flow at D within one step.  Lift and drag are limited to it,
  /// because a larger force would reverse the flow within the step, which is unphysical.
  double max_force_N(double speed_mps, double step_s) const { return mass_at_D_kg_ * speed_mps / step_s; }
  /// Adds a force in D at the origin of D.
  void add_force_D(const WaterFlow& flow, const sim::Vector3d& force_N) { add_force_W(flow, in_W(flow, force_N)); }
  /// Adds a force in W at the origin of D.
  void add_force_W(const WaterFlow& flow, const sim::Vector3d& force_N) {
    body_.add_force_at_W(force_N, flow.body.R_WB * p_CD_);
  }
  /// Adds a torque in D.
  void add_torque_D(const WaterFlow& flow, const sim::Vector3d& torque_Nm) {
    body_.add_torque_W(in_W(flow, torque_Nm));
  }
  sim::Body& body() { return body_; }
  const sim::World& world() const { return world_; }

 private:
  const sim::World& world_;
  sim::Body& body_;
  sim::Vector3d p_BD_, p_CD_;
  sim::Matrix3d R_BD_;
  bool turned_;
  double mass_at_D_kg_;
  /// Returns a lower bound of the effective mass of the body at a point, without added mass.
  static double mass_at(const sim::Body& body, const sim::Vector3d& p_BD);
  WaterFlow flow_without_cache() const;
};

/// Returns the immersed share of a device of the given height whose center is at `depth_m`: 0 to 1, smooth at both
/// ends.
inline double share_under_water(double depth_m, double height_m) {
  const double share = depth_m / height_m + 0.5;
  if (share >= 1) return 1;
  if (share <= 0) return 0;
  return share * share * (3 - 2 * share);
}

}  // namespace devices
