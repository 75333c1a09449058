// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/moving_mass.hpp"

#include <algorithm>
#include <cmath>

#include "sim/vehicle/device_context.hpp"

namespace devices {

void MovingMass::Params::read(sim::ParamReader& in) {
  in.read_choice("motion", motion, {{"slide", MassMotion::slide}, {"turn", MassMotion::turn}},
                 "slide: along x of the device's frame; turn: about it, hanging along -z");
  in.read("mass_kg", mass_kg, sim::above_to(0, 1e6), "mass of what moves; part of the vehicle's mass");
  in.read("max_m", max_m, sim::between(0, 1000), "slide: maximum forward travel");
  in.read("min_m", min_m, sim::between(-1000, 0), "slide: maximum backward travel; unset: -max_m");
  in.read("rate_mps", rate_mps, sim::above(0), "slide: maximum speed");
  in.read("radius_m", radius_m, sim::between(0, 1000), "turn: of its center of mass about the axis");
  in.read_deg("limit_deg", limit_rad, sim::above_to(0, 180), "turn: maximum angle to each side");
  in.read("rate_degps", rate_degps, sim::above(0), "turn: maximum rate");
  lag.read(in);
}

MovingMass::MovingMass(const Params& params, const sim::DeviceContext& context)
    : world_(context.world), body_(context.body), R_BD_(context.config.X_BS().linear()) {
  change(params);
}

void MovingMass::change(const Params& params) {
  params_ = params;
  lag_.set(params.lag,
           params.motion == MassMotion::slide ? params.rate_mps : sim::degrees_to_radians(params.rate_degps));
  desired_ = std::clamp(desired_, params.lower(), params.upper());
}

void MovingMass::set_command(double command) {
  desired_ = std::clamp(command, params_.lower(), params_.upper());
}

void MovingMass::make_safe(sim::SafeState safe) {
  if (safe == sim::SafeState::hold) {
    lag_.jump_to(lag_.value());
    desired_ = std::clamp(lag_.value(), params_.lower(), params_.upper());
  } else {
    desired_ = 0;
  }
}

sim::Vector3d MovingMass::offset_D(double place) const {
  if (params_.motion == MassMotion::slide) return {place, 0, 0};
  // Right-hand rule about x: from -z towards +y.
  return {0, params_.radius_m * std::sin(place), params_.radius_m * (1 - std::cos(place))};
}

void MovingMass::act(const sim::ActContext& context) {
  const double h = context.effectiveness * context.step_s;
  const double place = h > 0 ? lag_.follow_through(desired_, h) : lag_.value();
  if (place == 0) return;
  const sim::Vector3d offset_B = R_BD_ * offset_D(place);
  const sim::Vector3d offset_W = world_.hydrodynamics().motion_of(body_).R_WB * offset_B;
  const double weight_N = params_.mass_kg * world_.physics().gravity_mps2();
  body_.add_torque_W(offset_W.cross(sim::Vector3d(0, 0, -weight_N)));
}

void MovingMass::visit_state(sim::StateArchive& archive) {
  archive(lag_, desired_);
}

SHOAL_ACTUATOR("moving_mass", MovingMass, NumberController<MovingMass>);

}  // namespace devices
