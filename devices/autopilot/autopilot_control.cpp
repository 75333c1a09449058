// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/autopilot_control.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "devices/autopilot/autopilot_actuators.hpp"
#include "sim/hydrodynamics/level_speed.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/world/world.hpp"

namespace devices {

void HoldGains::read(sim::ParamReader& in) {
  in.read("bandwidth_radps", bandwidth_radps, sim::above_to(0, 100), "errors decay within a few times 1 / bandwidth");
  in.read("damping", damping, sim::between(0.3, 10), "1: no overshoot");
  in.read("rate_max", rate_max, sim::above(0), "rate limit: m/s, or rad/s for an angle");
  in.read("integral", integral, sim::between(0, 0.5),
          "bandwidth of the disturbance estimate over that of the controller; 0: a steady error remains");
}

double Disturbance::update(double rate, double given, double dt_s, double weight) {
  if (rate_before_ && dt_s > 0) {
    const double found = (rate - *rate_before_) / dt_s - given;
    estimate_ += std::min(1.0, weight * bandwidth_radps_ * dt_s) * (found - estimate_);
  }
  rate_before_ = rate;
  return estimate_;
}

void Disturbance::reset() {
  estimate_ = 0;
  rate_before_.reset();
}

double AxisHold::step(double error, double rate, double given, double dt_s) {
  const double w = gains_.bandwidth_radps, damping = gains_.damping;
  const double desired = w / (2 * damping) * error;
  const double rate_desired = std::clamp(desired, -gains_.rate_max, gains_.rate_max);
  const double missed = desired == rate_desired ? 1 : 1 - std::clamp(rate / rate_desired, 0.0, 1.0);
  return 2 * damping * w * (rate_desired - rate) - disturbance_.update(rate, given, dt_s, missed);
}

namespace {

using sim::LevelMotion;

std::string rounded(double value) {
  return fmt::format("{:.2f}", value);
}

/// Returns the speed that the thrusters reach against the drag.
double top_mps(AutopilotActuators& actuators, const sim::CoefficientModel& model, LevelMotion motion) {
  constexpr double any_N = 1e9, fastest_mps = 20;
  const int axis = motion == LevelMotion::ahead ? 0 : 1;
  return sim::last_where(0, fastest_mps, [&](double speed_mps) {
    const auto given = actuators.share(any_N * Wrench::Unit(axis), speed_mps * sim::Vector3d::Unit(axis), 0);
    return given.wrench[axis] > sim::level_drag_N(model, motion, speed_mps);
  });
}

}  // namespace

void check_level(AutopilotActuators& actuators, const HoldGains& attitude, const sim::DeviceContext& context) {
  const sim::HydrodynamicsConfig* water = hydrodynamics_of(context);
  const CraftAbilities craft = actuators.abilities();
  // The waterline holds a surface craft upright, and fins in the flow a slender hull. Only a hull that thrusters
  // alone hold can be turned over by the Munk moment.
  if (water == nullptr || water->waterline || craft.fins) return;
  const sim::CoefficientModel model(*water, context.world.config().physics.gravity_mps2);
  double needed_radps = 0;
  bool held = true;
  std::string limits, tops;
  for (const LevelMotion motion : {LevelMotion::ahead, LevelMotion::sideways}) {
    const int axis = motion == LevelMotion::ahead ? 4 : 3;
    if (motion == LevelMotion::sideways && !craft.sideways) continue;
    // The attitude loop acts as a stiffness of inertia times bandwidth squared, which adds to the righting moment.
    const double inertia = craft.mass[axis], w = actuators.gives(axis) ? attitude.bandwidth_radps : 0;
    const double tipping = sim::tipping_mps(model, motion, inertia * w * w);
    if (std::isinf(tipping)) continue;
    const double top = top_mps(actuators, model, motion);
    const std::string separator = limits.empty() ? "" : " and ";
    limits += separator + rounded(tipping) + (motion == LevelMotion::ahead ? " m/s ahead" : " m/s to the side");
    tops += separator + rounded(top) + " m/s";
    if (tipping >= top) continue;
    held = false;
    needed_radps = actuators.gives(axis)
                       ? std::max(needed_radps, std::sqrt(-sim::righting_Nmprad(model, motion, top) / inertia))
                       : std::numeric_limits<double>::infinity();
  }
  if (limits.empty()) return;
  const sim::DeviceConfig& config = context.config;
  const sim::SourcePlace place = config.source ? sim::place_of(*config.source, "gains") : config.place;
  const std::string who = "vehicle '" + context.vehicle.name() + "': device '" + config.name + "'";
  sim::Warnings& warnings = context.host.warnings.building();
  const std::string up_to = "it holds the vehicle level up to " + limits + "; the thrusters reach " + tops;
  if (held) return warnings.note(place, who, up_to);
  warnings.warn(
      place, who,
      up_to + ": above it, the Munk moment of the added mass turns it over" +
          (std::isinf(needed_radps) ? ", for the thrusters do not control its tilt"
                                    : ", unless 'gains: attitude: bandwidth_radps' is above " + rounded(needed_radps)));
}

}  // namespace devices
