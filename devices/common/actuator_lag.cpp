// SPDX-License-Identifier: BSD-3-Clause
#include "devices/common/actuator_lag.hpp"

#include <algorithm>
#include <cmath>

namespace devices {

void LagParams::read(sim::ParamReader& in) {
  in.read("lag_s", lag_s, sim::at_least(0), "time constant of a first-order lag; 0: none");
  in.read_or_word("natural_frequency_radps", natural_frequency_radps, sim::between(1e-3, 1e5), {"none"},
                  "natural frequency of a second-order response, instead of lag_s");
  in.read("damping_ratio", damping_ratio, sim::above_to(0, 1e3), "damping ratio of the second-order response");
  if (lag_s > 0 && natural_frequency_radps > 0)
    in.error("natural_frequency_radps", "'lag_s' and 'natural_frequency_radps' exclude each other");
}

void Lag::set(const LagParams& params, double rate_limit) {
  params_ = params;
  rate_limit_ = rate_limit;
  prepared_for_s_ = -1;
}

void Lag::prepare(double h) {
  prepared_for_s_ = h;
  rest_of_rest_ = rest_of_rate_ = rate_of_rest_ = rate_of_rate_ = 0;
  const double w = params_.natural_frequency_radps, z = params_.damping_ratio;
  // First-order lag.
  if (w == 0) {
    if (params_.lag_s > 0) rest_of_rest_ = std::exp(-h / params_.lag_s);
    return;
  }
  // Solution of x'' + 2 z w x' + w^2 x = 0.  `s` and `c` are sine and cosine of the damped oscillation, or hyperbolic
  // sine and cosine when overdamped; s is divided by its frequency.
  const double decay = std::exp(-z * w * h);
  double s = h * decay, c = decay;
  if (z < 1) {
    const double damped = w * std::sqrt(1 - z * z);
    s = decay * std::sin(damped * h) / damped;
    c = decay * std::cos(damped * h);
  } else if (z > 1) {
    const double spread = w * std::sqrt(z * z - 1);
    const double slow = std::exp((spread - z * w) * h), fast = std::exp((-spread - z * w) * h);
    s = (slow - fast) / (2 * spread);
    c = (slow + fast) / 2;
  }
  // Transition matrix of difference and rate.
  rest_of_rest_ = c + z * w * s;
  rest_of_rate_ = s;
  rate_of_rest_ = -w * w * s;
  rate_of_rate_ = c - z * w * s;
}

double Lag::follow(double target, double step_s) {
  // The coefficients are exact for a constant target, whatever the step, and are computed once.
  if (step_s != prepared_for_s_) prepare(step_s);
  const double rest = value_ - target;
  const double max = rate_limit_ * step_s;
  const double change = rest_of_rest_ * rest + rest_of_rate_ * rate_ - rest;
  if (params_.natural_frequency_radps > 0)
    rate_ = std::clamp(rate_of_rest_ * rest + rate_of_rate_ * rate_, -rate_limit_, rate_limit_);
  if (std::abs(change) > max)
    value_ += std::copysign(max, change);
  else
    // Written so that without a lag the value is exactly the target.
    value_ = target + (rest + change);
  return value_;
}

void Lag::jump_to(double value) {
  value_ = value;
  rate_ = 0;
}

}  // namespace devices
