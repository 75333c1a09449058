// SPDX-License-Identifier: BSD-3-Clause
#include "sim/random/noise.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace sim {

void NoiseParams::read(ParamReader& in) {
  in.read("scale_error", scale_error, any_number(), "measured = truth * (1 + scale_error)");
  in.read("bias", bias, any_number(), "constant offset");
  in.read("bias_std", bias_std, at_least(0), "standard deviation of a constant offset drawn once per run");
  in.read("random_walk_std", random_walk_std, at_least(0),
          "standard deviation of the drift after 1 s; grows with the square root of time");
  in.read("gauss_markov_std", gauss_markov_std, at_least(0), "standard deviation of a slowly changing error");
  in.read("gauss_markov_time_s", gauss_markov_time_s, above(0), "correlation time of that error");
  in.read("gaussian_std", gaussian_std, at_least(0), "standard deviation of white noise, drawn for each value");
  in.read("uniform_half_width", uniform_half_width, at_least(0), "half width of uniform white noise");
  in.read("outlier_probability", outlier_probability, between(0, 1), "share of values that are outliers");
  in.read("outlier_std", outlier_std, at_least(0), "standard deviation of the error of an outlier");
  in.read("quantization", quantization, at_least(0), "step of the output; 0: none");
  in.read("saturation", saturation, above(0), "limit of the magnitude of the output (saturation); unset: no limit");
}

bool NoiseParams::any() const {
  const bool offsets = scale_error != 0 || bias != 0 || bias_std > 0;
  const bool slow = random_walk_std > 0 || gauss_markov_std > 0;
  const bool white = gaussian_std > 0 || uniform_half_width > 0 || (outlier_probability > 0 && outlier_std > 0);
  return offsets || slow || white || quantization > 0 || saturation.has_value();
}

Noise::Noise(const NoiseParams& params, int values, Random bias_source, const NoiseFault* fault)
    : params_(params), fault_(fault), slow_(static_cast<std::size_t>(std::max(values, 1))) {
  assert(values >= 1);
  for (Slow& slow : slow_) {
    slow.drawn = params_.bias_std * bias_source.gaussian();
    slow.bias = params_.bias + slow.drawn;
  }
}

void Noise::change(const NoiseParams& params) {
  for (Slow& slow : slow_) slow.bias = params.bias + slow.drawn;
  params_ = params;
  planned_dt_s_ = -1;
}

void Noise::apply(std::span<double> values, double dt_s, Random& random) {
  advance(dt_s, random);
  const NoiseParams& p = params_;
  const NoiseFault fault = fault_ ? *fault_ : NoiseFault{};
  // Scale error, bias and slow errors.
  std::size_t state = 0;
  for (double& value : values) {
    const Slow& slow = slow_[state];
    if (++state == slow_.size()) state = 0;
    value = value * (1 + p.scale_error) + slow.bias + fault.factor * (slow.walk + slow.gauss_markov) + fault.bias;
  }
  // One loop per part, so that a scan of hundreds of beams tests each part once.
  if (p.gaussian_std > 0)
    for (double& value : values) value += fault.factor * p.gaussian_std * random.gaussian();
  if (p.uniform_half_width > 0)
    for (double& value : values) value += fault.factor * p.uniform_half_width * (2 * random.uniform() - 1);
  if (p.outlier_probability > 0 && p.outlier_std > 0)
    for (double& value : values)
      if (random.uniform() < p.outlier_probability) value += fault.factor * p.outlier_std * random.gaussian();
  if (p.quantization > 0)
    for (double& value : values) value = p.quantization * std::round(value / p.quantization);
  if (p.saturation)
    for (double& value : values) value = std::clamp(value, -*p.saturation, *p.saturation);
}

void Noise::apply(double& value, double dt_s, Random& random) {
  apply(std::span(&value, 1), dt_s, random);
}

void Noise::plan(double dt_s) {
  // Samples usually have a constant rate, so that these coefficients are reused.
  planned_dt_s_ = dt_s;
  walk_root_s_ = std::sqrt(dt_s);
  kept_ = std::exp(-dt_s / params_.gauss_markov_time_s);
  fresh_std_ = params_.gauss_markov_std * std::sqrt(-std::expm1(-2 * dt_s / params_.gauss_markov_time_s));
}

void Noise::advance(double dt_s, Random& random) {
  const NoiseParams& p = params_;
  if (p.random_walk_std == 0 && p.gauss_markov_std == 0) {
    started_ = true;
    return;
  }
  if (dt_s != planned_dt_s_) plan(dt_s);
  if (p.random_walk_std > 0 && started_) {
    const double step_std = p.random_walk_std * walk_root_s_;
    for (Slow& slow : slow_) slow.walk += step_std * random.gaussian();
  }
  if (p.gauss_markov_std > 0) {
    // Exact discretization keeps the standard deviation for any dt.  The first value is drawn from the stationary
    // distribution, as of an instrument that has been on for a long time.
    const double kept = started_ ? kept_ : 0;
    const double fresh_std = started_ ? fresh_std_ : p.gauss_markov_std;
    for (Slow& slow : slow_) slow.gauss_markov = kept * slow.gauss_markov + fresh_std * random.gaussian();
  }
  started_ = true;
}

}  // namespace sim
