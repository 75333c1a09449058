#pragma once

#include "sim/device/device_registry.hpp"
#include "sim/hydrodynamics/hydrodynamics.hpp"
#include "sim/physics/body.hpp"
#include "sim/world/world.hpp"

namespace devices {

/// A device frame D in the water, at this moment.
struct WaterFlow {
  sim::Matrix3d R_WB;
  sim::Vector3d p_WD;        ///< origin of the device frame
  sim::Vector3d v_D;         ///< of that origin through the water, in D, m/s
  double depth_m = 0;        ///< of that origin below the surface
  double density_kgpm3 = 0;  ///< of the water; 0 in a world without
  sim::Vector3d water_W;     ///< velocity of the water, m/s
};

/// Where on a body in the water an actuator sits: the flow there, and forces from there.
class WaterMount {
 public:
  explicit WaterMount(const sim::DeviceContext& context)
      : world_(context.world),
        body_(context.body),
        p_BD_(context.config.X_BS().translation()),
        R_BD_(context.config.X_BS().linear()) {}

  WaterFlow flow() const {
    WaterFlow flow;
    const sim::Pose X_WB = body_.X_WB();
    flow.R_WB = X_WB.linear();
    flow.p_WD = X_WB * p_BD_;
    const sim::LocalWater* water = &world_.hydrodynamics().water_at(body_);
    sim::LocalWater here;
    // A body that the water does nothing to can have a propeller all the same.
    if (water->density_kgpm3 == 0 && world_.medium().has_water()) water = &(here = world_.medium().water_at(flow.p_WD));
    flow.density_kgpm3 = water->density_kgpm3;
    flow.depth_m = water->surface_m - flow.p_WD.z();
    flow.water_W = water->velocity_W;
    flow.v_D = R_BD_.transpose() * (flow.R_WB.transpose() * (body_.velocity_at_W(p_BD_) - water->velocity_W));
    return flow;
  }
  /// Of the body's origin through the water, in D, m/s.
  sim::Vector3d origin_velocity_D(const WaterFlow& flow) const {
    return R_BD_.transpose() * (flow.R_WB.transpose() * (body_.v_WB_W() - flow.water_W));
  }
  /// At the origin of D.
  void add_force_D(const WaterFlow& flow, const sim::Vector3d& force_N) {
    body_.add_force_W(flow.R_WB * (R_BD_ * force_N), flow.p_WD);
  }
  void add_torque_D(const WaterFlow& flow, const sim::Vector3d& torque_Nm) {
    body_.add_torque_W(flow.R_WB * (R_BD_ * torque_Nm));
  }
  sim::Body& body() { return body_; }
  const sim::Body& body() const { return body_; }
  const sim::World& world() const { return world_; }

 private:
  const sim::World& world_;
  sim::Body& body_;
  sim::Vector3d p_BD_;
  sim::Matrix3d R_BD_;
};

/// Share of something of this height that is under water when its middle is at `depth_m`: 0 to 1, smooth at both ends.
inline double share_under_water(double depth_m, double height_m) {
  const double share = depth_m / height_m + 0.5;
  if (share >= 1) return 1;
  if (share <= 0) return 0;
  return share * share * (3 - 2 * share);
}

}  // namespace devices
