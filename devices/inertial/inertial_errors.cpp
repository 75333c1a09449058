// SPDX-License-Identifier: BSD-3-Clause
#include "devices/inertial/inertial_errors.hpp"

#include <cmath>

#include "sim/world/world.hpp"

namespace devices {

double gauss_markov_allan_deviation(double correlation_times) {
  const double x = correlation_times;
  return std::sqrt(2 / x * (1 - (3 - 4 * std::exp(-x) + std::exp(-2 * x)) / (2 * x)));
}

InertialErrors::InertialErrors(const InertialParams& params, const sim::NoiseParams& noise,
                               const sim::DeviceContext& context)
    // A data sheet gives densities of noise; a sample's deviation follows from the interval.
    : params_(params),
      noise_(context.noise(noise, 3)),
      fault_(*context.noise_origin(noise).fault),
      nominal_dt_s_(context.config.rate_hz > 0 ? 1 / context.config.rate_hz
                                               : sim::to_seconds(context.world.step_time())) {
  // Drawn once for each unit, from its own stream: other noise does not change which unit it is.
  sim::Random random(context.world.seed(), context.full_name() + "#" + noise.key + "/unit");
  for (int i = 0; i < 3; ++i) drawn_bias_[i] = random.gaussian();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) drawn_matrix_(row, column) = random.gaussian();
  use(params);
}

void InertialErrors::change(const InertialParams& params, const sim::NoiseParams& noise) {
  noise_.change(noise);
  use(params);
}

void InertialErrors::use(const InertialParams& params) {
  params_ = params;
  turn_on_bias_ = params.turn_on_bias * drawn_bias_;
  matrix_ = params.misalignment_rad * drawn_matrix_;
  for (int i = 0; i < 3; ++i) matrix_(i, i) = 1 + params.scale * drawn_matrix_(i, i);
  cached_dt_s_ = -1;
}

void InertialErrors::plan(double dt_s) {
  cached_dt_s_ = dt_s;
  // White noise of density N averaged over dt has the standard deviation N / sqrt(dt).
  white_std_ = params_.random_walk / std::sqrt(dt_s);
  walk_std_ = params_.rate_random_walk * std::sqrt(dt_s);
  const double sigma = params_.bias_instability / gauss_markov_allan_peak;
  kept_ = std::exp(-dt_s / params_.bias_time_s);
  fresh_std_ = sigma * std::sqrt(-std::expm1(-2 * dt_s / params_.bias_time_s));
}

void InertialErrors::add_random_parts(sim::Vector3d& value, sim::Random& random) {
  const double factor = fault_.factor;
  if (params_.bias_instability > 0) {
    // Draw the first value from the stationary distribution: the unit was switched on earlier.
    const double kept = started_ ? kept_ : 0;
    const double fresh_std = started_ ? fresh_std_ : params_.bias_instability / gauss_markov_allan_peak;
    for (int i = 0; i < 3; ++i) gauss_markov_[i] = kept * gauss_markov_[i] + fresh_std * random.gaussian();
    value += factor * gauss_markov_;
  }
  if (params_.rate_random_walk > 0) {
    if (started_)
      for (int i = 0; i < 3; ++i) walk_[i] += walk_std_ * random.gaussian();
    value += factor * walk_;
  }
  if (params_.random_walk > 0)
    for (int i = 0; i < 3; ++i) value[i] += factor * white_std_ * random.gaussian();
}

void InertialErrors::apply(sim::Vector3d& value, double dt_s, sim::Random& random) {
  const double interval_s = dt_s > 0 ? dt_s : nominal_dt_s_;
  if (interval_s != cached_dt_s_) plan(interval_s);
  value = matrix_ * value + turn_on_bias_;
  noise_.apply(std::span<double>(value.data(), 3), dt_s, random);
  add_random_parts(value, random);
  started_ = true;
  if (params_.range > 0) value = value.cwiseMax(-params_.range).cwiseMin(params_.range);
  if (params_.resolution > 0)
    for (int i = 0; i < 3; ++i) value[i] = params_.resolution * std::round(value[i] / params_.resolution);
}

}  // namespace devices
