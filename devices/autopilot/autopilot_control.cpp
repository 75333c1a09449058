// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/autopilot_control.hpp"

#include <algorithm>
#include <cmath>

namespace devices {

void HoldGains::read(sim::ParamReader& in) {
  in.read("bandwidth_radps", bandwidth_radps, sim::above_to(0, 100), "errors decay within a few times 1 / bandwidth");
  in.read("damping", damping, sim::between(0.3, 10), "1: no overshoot");
  in.read("rate_max", rate_max, sim::above(0), "rate limit: m/s, or rad/s for an angle");
  in.read("integral", integral, sim::between(0, 0.5),
          "gain of the integral of the error, which removes a steady error");
}

double AxisHold::step(double error, double rate, double dt_s, bool frozen) {
  const double w = gains_.bandwidth_radps, damping = gains_.damping;
  const double desired = w / (2 * damping) * error;
  const double rate_desired = std::clamp(desired, -gains_.rate_max, gains_.rate_max);
  // Hold the integral while the rate is limited (anti-windup).
  if (!frozen && desired == rate_desired) sum_ += gains_.integral * w * w * w * error * dt_s;
  return 2 * damping * w * (rate_desired - rate) + sum_;
}

double RateHold::step(double error, double dt_s, bool frozen) {
  if (!frozen) sum_ += integral_ * bandwidth_radps_ * bandwidth_radps_ * error * dt_s;
  return bandwidth_radps_ * error + sum_;
}

}  // namespace devices
