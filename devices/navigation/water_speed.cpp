// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/water_speed.hpp"

#include <algorithm>
#include <cmath>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/water_speed_t.hpp"
#include "sim/world/world.hpp"

namespace devices {

void WaterSpeed::Params::read(sim::ParamReader& in) {
  in.read_choice("senses", senses,
                 {{"both", Senses::both}, {"forward", Senses::forward}, {"magnitude", Senses::magnitude}},
                 "both: the speed with its sign; forward: 0 when the water comes from behind, like a pitot tube; "
                 "magnitude: without its sign, like a paddle wheel");
  in.read("threshold_mps", threshold_mps, sim::at_least(0), "below this speed it reports 0, as a paddle wheel sticks");
  in.read("speed_max_mps", speed_max_mps, sim::above(0), "maximum speed that it reports");
  in.read("speed_noise", speed_noise, "error of the speed, m/s");
}

WaterSpeed::WaterSpeed(const Params& params, const sim::DeviceContext& context)
    : params_(params), speed_noise_(context, params) {}

void WaterSpeed::measure(const sim::SenseContext& context) {
  const sim::Medium& medium = context.world.medium();
  const sim::Vector3d& p_WS = context.X_WS.translation();
  speed_mps_ = 0;
  valid_ = medium.in_water(p_WS);
  if (!valid_) return;
  speed_mps_ = context.X_WS.linear().col(0).dot(context.v_WS_W - medium.water_velocity_W(p_WS));
  switch (params_.senses) {
    case Senses::both:
      break;
    case Senses::forward:
      speed_mps_ = std::max(speed_mps_, 0.0);
      break;
    case Senses::magnitude:
      speed_mps_ = std::abs(speed_mps_);
      break;
  }
  // The threshold is applied after the kind of sensor: a paddle wheel sticks in slow flow from either side.
  if (std::abs(speed_mps_) < params_.threshold_mps) speed_mps_ = 0;
  speed_mps_ = std::clamp(speed_mps_, -params_.speed_max_mps, params_.speed_max_mps);
}

void WaterSpeed::disturb(double dt_s, sim::Random& random) {
  speed_noise_.apply(speed_mps_, dt_s, random);
  speed_mps_ = std::clamp(speed_mps_, -params_.speed_max_mps, params_.speed_max_mps);
  if (!valid_) speed_mps_ = 0;
}

void WaterSpeed::visit_state(sim::StateArchive& archive) {
  archive(speed_mps_, valid_, speed_noise_);
}

void fill(const WaterSpeed& sensor, shoal::water_speed_t& message) {
  message.speed_mps = sensor.speed_mps();
  message.valid = sensor.valid();
}

SHOAL_SENSOR("water_speed", WaterSpeed, shoal::water_speed_t);

}  // namespace devices
