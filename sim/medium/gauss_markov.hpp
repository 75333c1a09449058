// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "sim/base/math.hpp"
#include "sim/base/time.hpp"
#include "sim/random/random.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// The share of a Gauss-Markov value that is left after dt: e^(-dt / T), with T = 1 / mu.
inline double kept_share(double dt_s, double correlation_time_s) {
  return std::exp(-dt_s / correlation_time_s);
}
/// Standard deviation of what is new after dt, of the process dV = -mu V dt + sigma dW, whose stationary standard
/// deviation is std = sigma / sqrt(2 mu): std sqrt(1 - e^(-2 dt / T)).
inline double fresh_std(double std, double dt_s, double correlation_time_s) {
  return std * std::sqrt(-std::expm1(-2 * dt_s / correlation_time_s));
}

/// Three first order Gauss-Markov processes of one correlation time, by their exact discretisation.  They are drawn at
/// the ticks of a grid of time of their own, a fiftieth of the correlation time apart, and go straight between two:
/// the values at a time do not depend on the steps that led there.  Between ticks the variance is up to 1 % less.
class GaussMarkov {
 public:
  /// `std`: stationary, of each.
  GaussMarkov(const Vector3d& std, double correlation_time_s, Random random);

  /// Not back in time.
  void advance_to(Time now);
  const Vector3d& values() const { return values_; }
  /// After restoring values() follow at the next advance_to().
  void visit_state(StateArchive& archive) { archive(tick_, from_, to_); }

 private:
  Vector3d draw(std::int64_t tick);

  Vector3d std_;
  double correlation_time_s_;
  std::int64_t tick_us_;
  Random random_;
  std::int64_t tick_ = 0;  ///< `from_` holds at this one, `to_` at the next
  Vector3d from_, to_, values_;
};

}  // namespace sim
