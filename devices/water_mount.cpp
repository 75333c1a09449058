#include "devices/water_mount.hpp"

namespace devices {

WaterFlow WaterMount::flow() const {
  WaterFlow flow;
  flow.body = body_.motion();
  const sim::Vector3d lever_W = flow.body.R_WB * p_BD_;
  flow.p_WD = flow.body.p_WB + lever_W;
  flow.v_WD_W = flow.body.v_WB_W + flow.body.w_WB_W.cross(lever_W);
  const auto take = [&](const sim::LocalWater& water) {
    flow.density_kgpm3 = water.density_kgpm3;
    flow.depth_m = water.surface_m - flow.p_WD.z();
    flow.water_W = water.velocity_W;
  };
  const sim::LocalWater& water = world_.hydrodynamics().water_at(body_);
  // A body that the water does nothing to can have a propeller all the same.
  if (water.density_kgpm3 == 0 && world_.medium().has_water())
    take(world_.medium().water_at(flow.p_WD));
  else
    take(water);
  const sim::Vector3d through_W = flow.v_WD_W - flow.water_W;
  flow.v_D = in_D(flow, through_W);
  return flow;
}

}  // namespace devices
