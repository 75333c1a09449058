// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/clock.hpp"

#include <limits>

#include "shoal/clock_status_t.hpp"
#include "shoal/message_codec.hpp"
#include "sim/world/world.hpp"

namespace devices {

Clock::Clock(const Params&, const sim::DeviceContext& context)
    : clock_(context.vehicle.clock()), last_error_s_(clock_.error_s(context.world.now())) {}

void Clock::measure(const sim::SenseContext& context) {
  reading_.disciplined = clock_.disciplined(context.now);
  reading_.since_fix_s = clock_.since_fix_s(context.now);
  reading_.estimated_std_s = clock_.estimated_std_s(context.now);
  reading_.error_s = clock_.error_s(context.now);
  reading_.rate_error = context.dt_s > 0 ? (reading_.error_s - last_error_s_) / context.dt_s : clock_.rate_error();
  last_error_s_ = reading_.error_s;
}

void Clock::disturb(double, sim::Random&) {
  reading_.error_s = reading_.rate_error = std::numeric_limits<double>::quiet_NaN();
}

void ClockReporter::report(sim::Time sampled_at, sim::Publisher& out) const {
  const Clock::Reading& reading = clock_.reading();
  shoal::clock_status_t message;
  message.utime = out.utime(sampled_at);
  message.disciplined = reading.disciplined;
  message.since_fix_s = reading.since_fix_s;
  message.estimated_std_s = reading.estimated_std_s;
  message.error_s = reading.error_s;
  message.rate_error = reading.rate_error;
  shoal::encode_into(message, out.buffer());
  out.publish(out.buffer());
}

SHOAL_SENSOR("clock", Clock, ClockReporter);

}  // namespace devices
