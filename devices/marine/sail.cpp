// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/sail.hpp"

#include <algorithm>
#include <cmath>

namespace devices {

void Sail::Params::read(sim::ParamReader& in) {
  in.read("area_m2", area_m2, sim::above_to(0, 1e5), "area of the sail");
  foil.read(in);
  in.read_deg("limit_deg", limit_rad, sim::above_to(0, 180), "maximum angle of the sheet");
  in.read_deg("initial_deg", initial_rad, sim::between(0, 180), "angle of the sheet at the start");
  in.read("rate_degps", rate_degps, sim::above(0), "rate of the winch");
  lag.read(in);
  if (!in.describing() && initial_rad > limit_rad && in.has("initial_deg"))
    in.error("initial_deg", "'initial_deg' must be at most 'limit_deg'");
}

Sail::Sail(const Params& params, const sim::DeviceContext& context) : mount_(context), foil_(params.foil) {
  desired_rad_ = std::min(params.initial_rad, params.limit_rad);
  lag_.jump_to(desired_rad_);
  change(params);
}

void Sail::change(const Params& params) {
  params_ = params;
  foil_ = Foil(params.foil);
  lag_.set(params.lag, sim::degrees_to_radians(params.rate_degps));
  desired_rad_ = std::min(desired_rad_, params.limit_rad);
}

void Sail::set_command(double sheet_rad) {
  desired_rad_ = std::clamp(sheet_rad, 0.0, params_.limit_rad);
}

void Sail::make_safe(sim::SafeState safe) {
  if (safe == sim::SafeState::hold) lag_.jump_to(lag_.value());
  desired_rad_ = safe == sim::SafeState::hold ? lag_.value() : params_.limit_rad;
}

void Sail::act(const sim::ActContext& context) {
  const double h = context.effectiveness * context.step_s;
  const double sheet = std::clamp(h > 0 ? lag_.follow_through(desired_rad_, h) : lag_.value(), 0.0, params_.limit_rad);
  const sim::Medium& medium = mount_.world().medium();
  const WaterFlow flow = mount_.flow();
  if (flow.density_kgpm3 > 0 && flow.depth_m > 0) return;
  // Velocity of the sail relative to the air.
  const sim::Vector3d v_WD_W = flow.body.v_WB_W + flow.body.w_WB_W.cross(flow.p_WD - flow.body.p_WB);
  const sim::Vector3d v_D = mount_.in_D(flow, v_WD_W - medium.air_velocity_W(flow.p_WD));
  const double square = v_D.x() * v_D.x() + v_D.y() * v_D.y();
  if (square < 1e-12) return;
  const double speed = std::sqrt(square);
  const double mx = v_D.x() / speed, my = v_D.y() / speed;
  // The boom follows the wind up to the sheet.
  const double boom = std::clamp(std::atan2(my, mx), -sheet, sheet);
  // Lift and drag, limited for stability.
  const double pressure = 0.5 * medium.density_kgpm3(flow.p_WD) * square * params_.area_m2;
  const Eigen::Vector2d force = pressure * foil_.force(mx, my, boom);
  const double bound = std::min(1.0, mount_.max_force_N(speed, context.step_s) / force.norm());
  mount_.add_force_D(flow, {bound * force.x(), bound * force.y(), 0});
}

void Sail::visit_state(sim::StateArchive& archive) {
  archive(lag_, desired_rad_);
}

SHOAL_ACTUATOR("sail", Sail, NumberController<Sail>);

}  // namespace devices
