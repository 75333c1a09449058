// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/leak.hpp"

#include <algorithm>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/leak_t.hpp"
#include "sim/world/world.hpp"

namespace devices {

void Leak::Params::read(sim::ParamReader& in) {
  in.read("rated_depth_m", rated_depth_m, sim::above(0),
          "below this depth it starts to leak permanently; unset: never");
  in.read("leaking", leaking, "whether it leaks; can be changed by `set` in events");
  in.read("ingress_lps", ingress_lps, sim::above(0), "ingress while it leaks under water, liters per second");
  in.read("alarm_l", alarm_l, sim::above(0), "volume in the hull at which the probe raises the alarm, liters");
  in.read("volume_l", volume_l, sim::above(0), "volume of the hull, liters");
  in.read("water_noise", water_noise, "error of the water in the hull, liters; a fault's bias is a false alarm");
}

Leak::Leak(const Params& params, const sim::DeviceContext& context) : params_(params), water_noise_(context, params) {}

void Leak::measure(const sim::SenseContext& context) {
  const double depth_m = context.world.medium().depth_m(context.X_WS.translation());
  if (params_.rated_depth_m && depth_m > *params_.rated_depth_m) burst_ = true;
  if ((burst_ || params_.leaking) && depth_m > 0)
    water_l_ = std::min(water_l_ + params_.ingress_lps * context.dt_s, params_.volume_l);
  reading_l_ = water_l_;
}

void Leak::disturb(double dt_s, sim::Random& random) {
  water_noise_.apply(reading_l_, dt_s, random);
  reading_l_ = std::max(reading_l_, 0.0);
}

void Leak::visit_state(sim::StateArchive& archive) {
  archive(water_l_, burst_, reading_l_, water_noise_);
}

void fill(const Leak& leak, shoal::leak_t& message) {
  message.leak = leak.leak();
  message.water_l = leak.water_l();
}

SHOAL_SENSOR("leak", Leak, shoal::leak_t);

}  // namespace devices
