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

}  // namespace devices
