// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/physics/body.hpp"
#include "sim/vehicle/device_context.hpp"
#include "sim/world/world.hpp"

namespace devices {

/// A device frame D in the water, at this moment.
struct WaterFlow {
  sim::BodyMotion body;
  sim::Vector3d p_WD;        ///< origin of the device frame
  sim::Vector3d v_D;         ///< its velocity through the water, in D, m/s
  sim::Vector3d water_W;     ///< velocity of the water at the body, m/s
  double depth_m = 0;        ///< of that origin below the surface
  double density_kgpm3 = 0;  ///< of the water; 0 in a world without
};

/// Where on a body in the water an actuator sits: the flow there, and forces from there.
class WaterMount {
 public:
  explicit WaterMount(const sim::DeviceContext& context)
      : world_(context.world),
        body_(context.body),
        p_BD_(context.config.X_BS().translation()),
        R_BD_(context.config.X_BS().linear()),
        turned_(!R_BD_.isIdentity(0)),
        mass_at_D_kg_(mass_at(body_, p_BD_)) {}

  /// At the start of the step, before any force acts.
  WaterFlow flow() const;
  /// A velocity in the world, in the axes of D.
  sim::Vector3d in_D(const WaterFlow& flow, const sim::Vector3d& v_W) const {
    const sim::Vector3d v_B = flow.body.R_WB.transpose() * v_W;
    return turned_ ? sim::Vector3d(R_BD_.transpose() * v_B) : v_B;
  }
  sim::Vector3d in_W(const WaterFlow& flow, const sim::Vector3d& v_D) const {
    const sim::Vector3d v_B = turned_ ? sim::Vector3d(R_BD_ * v_D) : v_D;
    return flow.body.R_WB * v_B;
  }
  /// The largest force of a flow of this speed: one that stops the flow at D in a step.  A larger one would turn it
  /// round, which no lift and no drag does.
  double max_force_N(double speed_mps, double step_s) const { return mass_at_D_kg_ * speed_mps / step_s; }
  /// At the origin of D.
  void add_force_D(const WaterFlow& flow, const sim::Vector3d& force_N) {
    body_.add_force_W(in_W(flow, force_N), flow.p_WD);
  }
  void add_force_W(const WaterFlow& flow, const sim::Vector3d& force_N) { body_.add_force_W(force_N, flow.p_WD); }
  void add_torque_D(const WaterFlow& flow, const sim::Vector3d& torque_Nm) {
    body_.add_torque_W(in_W(flow, torque_Nm));
  }
  sim::Body& body() { return body_; }
  const sim::World& world() const { return world_; }

 private:
  const sim::World& world_;
  sim::Body& body_;
  sim::Vector3d p_BD_;
  sim::Matrix3d R_BD_;
  bool turned_;
  double mass_at_D_kg_;
  /// What a force at a place of the body has to move at least, without added mass.
  static double mass_at(const sim::Body& body, const sim::Vector3d& p_BD);
  WaterFlow flow_without_cache() const;
};

/// Share of something of this height that is under water when its middle is at `depth_m`: 0 to 1, smooth at both ends.
inline double share_under_water(double depth_m, double height_m) {
  const double share = depth_m / height_m + 0.5;
  if (share >= 1) return 1;
  if (share <= 0) return 0;
  return share * share * (3 - 2 * share);
}

}  // namespace devices
