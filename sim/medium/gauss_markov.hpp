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

/// Autocorrelation of a Gauss-Markov process after dt: e^(-dt / T), with T = 1 / mu.
inline double kept_share(double dt_s, double correlation_time_s) {
  return std::exp(-dt_s / correlation_time_s);
}
/// Standard deviation of the innovation after dt for the process dV = -mu V dt + sigma dW, whose stationary standard
/// deviation is std = sigma / sqrt(2 mu): std sqrt(1 - e^(-2 dt / T)).
inline double fresh_std(double std, double dt_s, double correlation_time_s) {
  return std * std::sqrt(-std::expm1(-2 * dt_s / correlation_time_s));
}

/// Three first-order Gauss-Markov processes with one correlation time, by exact discretization.  They are drawn on a
/// separate time grid with a spacing of a fiftieth of the correlation time, and interpolated linearly: values do not
/// depend on the steps taken to reach a time.  Between grid points the variance is up to 1 % lower.
class GaussMarkov {
 public:
  /// `std`: stationary standard deviation of each process.
  GaussMarkov(const Vector3d& std, double correlation_time_s, Random random);

  /// Advances to a time, which must not decrease.
  void advance_to(Time now);
  const Vector3d& values() const { return values_; }
  /// Visits the state; values() are updated by the next advance_to().
  void visit_state(StateArchive& archive) { archive(tick_, from_, to_); }

 private:
  Vector3d draw(std::int64_t tick);

  Vector3d std_;
  double correlation_time_s_;
  std::int64_t tick_us_;
  Random random_;
  std::int64_t tick_ = 0;  ///< grid point of `from_`; `to_` is at the next one
  Vector3d from_, to_, values_;
};

}  // namespace sim
