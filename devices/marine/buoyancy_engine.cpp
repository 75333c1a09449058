// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/buoyancy_engine.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace devices {

void BuoyancyEngine::Params::read(sim::ParamReader& in) {
  in.read_choice("command", command, {{"volume", Command::volume}, {"fraction", Command::fraction}},
                 "unit of a command: m^3, or a fraction of max_m3 (above 0) or min_m3");
  in.read("max_m3", max_m3, sim::between(0, 1e6), "largest volume");
  in.read("min_m3", min_m3, sim::between(-1e6, 0), "smallest volume");
  in.read("rate_m3ps", rate_m3ps, sim::above(0), "rate of the pump, m^3/s");
  in.read("initial_m3", initial_m3, sim::between(-1e6, 1e6), "volume at the start");
  in.read("park_m3", park_m3, sim::between(-1e6, 1e6),
          "volume of the safe state park; unset: max_m3, so that it surfaces");
  in.read("efficiency", efficiency, sim::above_to(0, 1), "work against the pressure over energy from the battery");
  lag.read(in);
  if (in.describing()) return;
  if (initial_m3 > max_m3 || initial_m3 < min_m3)
    in.error("initial_m3", "'initial_m3' must lie between 'min_m3' and 'max_m3'");
  if (park_m3 && (*park_m3 > max_m3 || *park_m3 < min_m3))
    in.error("park_m3", "'park_m3' must lie between 'min_m3' and 'max_m3'");
}

BuoyancyEngine::BuoyancyEngine(const Params& params, const sim::DeviceContext& context) : mount_(context) {
  desired_m3_ = params.initial_m3;
  lag_.jump_to(params.initial_m3);
  change(params);
}

void BuoyancyEngine::change(const Params& params) {
  params_ = params;
  lag_.set(params.lag, params.rate_m3ps);
  desired_m3_ = std::clamp(desired_m3_, params.min_m3, params.max_m3);
  // Diameter of a sphere of the largest volume.
  height_m_ = 2 * std::cbrt(std::max({params.max_m3, -params.min_m3, 1e-9}) * 3 / (4 * std::numbers::pi));
}

void BuoyancyEngine::make_safe(sim::SafeState safe) {
  if (safe == sim::SafeState::park) desired_m3_ = params_.park_m3.value_or(params_.max_m3);
  if (safe == sim::SafeState::stop) desired_m3_ = std::clamp(0.0, params_.min_m3, params_.max_m3);
  if (safe != sim::SafeState::hold) return;
  lag_.jump_to(lag_.value());
  desired_m3_ = lag_.value();
}

void BuoyancyEngine::set_command(double command) {
  if (params_.command == Command::fraction) command *= command > 0 ? params_.max_m3 : -params_.min_m3;
  desired_m3_ = std::clamp(command, params_.min_m3, params_.max_m3);
}

void BuoyancyEngine::act(const sim::ActContext& context) {
  const double before = lag_.value();
  const double h = context.effectiveness * context.step_s;
  const double volume = h > 0 ? lag_.follow_through(desired_m3_, h) : before;
  power_W_ = 0;
  if (volume == 0 && lag_.value() == before) return;
  const WaterFlow flow = mount_.flow();
  if (flow.density_kgpm3 == 0) return;
  const double weight_Npm3 = flow.density_kgpm3 * mount_.world().physics().gravity_mps2();
  // Power is needed only to displace water against the pressure, not to reduce the volume.
  power_W_ = std::max(lag_.value() - before, 0.0) / context.step_s * weight_Npm3 * std::max(flow.depth_m, 0.0) /
             params_.efficiency;
  mount_.add_force_W(flow, {0, 0, weight_Npm3 * volume * share_under_water(flow.depth_m, height_m_)});
}

SHOAL_ACTUATOR("buoyancy_engine", BuoyancyEngine, NumberController<BuoyancyEngine>);

}  // namespace devices
