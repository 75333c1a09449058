// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/water_mount.hpp"

#include "sim/base/math.hpp"

namespace devices {

double WaterMount::mass_at(const sim::Body& body, const sim::Vector3d& p_BD) {
  if (!(body.mass_kg() > 0)) return 0;
  const double smallest_inertia = sim::symmetric_eigenvalues(body.inertia_C_B())[0];
  return 1 / (1 / body.mass_kg() + (p_BD - body.p_BC()).squaredNorm() / smallest_inertia);
}

/// Returns the flow for a body without hydrodynamics, which can carry a propeller too.
WaterFlow WaterMount::flow_without_cache() const {
  WaterFlow flow;
  flow.body = world_.hydrodynamics().motion_of(body_);
  const sim::Vector3d lever_W = flow.body.R_WB * p_BD_;
  flow.p_WD = flow.body.p_WB + lever_W;
  const sim::LocalWater water = world_.medium().water_at(flow.p_WD);
  flow.density_kgpm3 = water.density_kgpm3;
  flow.depth_m = water.surface_m - flow.p_WD.z();
  flow.water_W = water.velocity_W;
  flow.v_B = flow.body.R_WB.transpose() * (flow.body.v_WB_W + flow.body.w_WB_W.cross(lever_W) - flow.water_W);
  return flow;
}

}  // namespace devices
