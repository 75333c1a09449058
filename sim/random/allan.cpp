// SPDX-License-Identifier: BSD-3-Clause
#include "sim/random/allan.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace sim {

namespace {

/// Sums of the first k samples, theta[k] / dt.  The mean is removed, which does not affect an Allan deviation, so that
/// the sums stay small and accurate.
std::vector<double> running_sum(std::span<const double> samples) {
  double mean = 0;
  for (const double sample : samples) mean += sample / static_cast<double>(samples.size());
  std::vector<double> sums(samples.size() + 1);
  for (std::size_t k = 0; k < samples.size(); ++k) sums[k + 1] = sums[k] + (samples[k] - mean);
  return sums;
}

AllanPoint point(const std::vector<double>& sums, double dt_s, std::size_t m) {
  // Overlapping Allan deviation from the integral of the data (IEEE Std 952).
  const std::size_t count = sums.size() - 2 * m;
  double squares = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double second_difference = sums[k + 2 * m] - 2 * sums[k + m] + sums[k];
    squares += second_difference * second_difference;
  }
  const auto length = static_cast<double>(m);
  const double clusters = static_cast<double>(sums.size() - 1) / length;
  // Approximate relative error with this many independent clusters (IEEE Std 952-1997, annex C).
  return {length * dt_s, std::sqrt(squares / (2 * length * length * static_cast<double>(count))),
          1 / std::sqrt(2 * (clusters - 1))};
}

}  // namespace

std::vector<AllanPoint> allan_deviation(std::span<const double> samples, double dt_s, int points_per_decade) {
  const std::vector<double> sums = running_sum(samples);
  std::vector<AllanPoint> points;
  std::size_t last = 0;
  for (int i = 0;; ++i) {
    const auto m = static_cast<std::size_t>(std::lround(std::pow(10.0, static_cast<double>(i) / points_per_decade)));
    if (4 * m > samples.size()) return points;
    if (m != last) points.push_back(point(sums, dt_s, m));
    last = m;
  }
}

AllanPoint allan_deviation_at(std::span<const double> samples, double dt_s, double tau_s) {
  const auto m = static_cast<std::size_t>(std::max(1L, std::lround(tau_s / dt_s)));
  assert(2 * m <= samples.size());
  return point(running_sum(samples), dt_s, m);
}

}  // namespace sim
