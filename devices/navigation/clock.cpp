// SPDX-License-Identifier: BSD-3-Clause
#include "devices/navigation/clock.hpp"

#include <limits>

#include "messages/reporter/message_reporter.hpp"
#include "shoal/clock_status_t.hpp"
#include "sim/world/world.hpp"

namespace devices {

Clock::Clock(const Params&, const sim::DeviceContext& context)
    : clock_(context.vehicle.clock()), last_error_s_(clock_.error_s(context.world.now())) {}

void Clock::measure(const sim::SenseContext& context) {
  reading_.disciplined = clock_.disciplined(context.now);
  reading_.since_fix_s = clock_.since_fix_s(context.now);
  reading_.estimated_std_s = clock_.estimated_std_s(context.now);
  reading_.error_s = clock_.error_s(context.now);
  reading_.rate_error =
      context.dt_s > 0 ? (reading_.error_s - last_error_s_) / context.dt_s : clock_.rate_error(context.now);
  last_error_s_ = reading_.error_s;
}

void Clock::disturb(double, sim::Random&) {
  reading_.error_s = reading_.rate_error = std::numeric_limits<double>::quiet_NaN();
}

void fill(const Clock& clock, shoal::clock_status_t& message) {
  const Clock::Reading& reading = clock.reading();
  message.disciplined = reading.disciplined;
  message.since_fix_s = reading.since_fix_s;
  message.estimated_std_s = reading.estimated_std_s;
  message.error_s = reading.error_s;
  message.rate_error = reading.rate_error;
}

SHOAL_SENSOR("clock", Clock, shoal::clock_status_t);

}  // namespace devices
