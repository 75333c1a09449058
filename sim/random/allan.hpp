// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

namespace sim {

/// Point of an Allan deviation.
struct AllanPoint {
  double tau_s = 0;           ///< averaging time
  double deviation = 0;       ///< in the unit of the samples
  double relative_error = 0;  ///< standard deviation of the estimate, relative to it
};

/// Computes the overlapping Allan deviation of samples at equal intervals of `dt_s`, each the mean over its interval:
/// sigma^2(m dt) = sum over k of (theta[k + 2 m] - 2 theta[k + m] + theta[k])^2 / (2 (m dt)^2 (N - 2 m + 1)), theta
/// being the running sum of the samples times dt (IEEE Std 952-1997, with all overlapping clusters).
/// `points_per_decade` averaging times, from dt_s to a quarter of the record.  Error: 1 / sqrt(2 (N / m - 1)), which
/// counts only the clusters that do not overlap, and is thus an upper estimate.
std::vector<AllanPoint> allan_deviation(std::span<const double> samples, double dt_s, int points_per_decade = 10);

/// The same at one averaging time, rounded to a multiple of dt_s.  Needs at least two clusters.
AllanPoint allan_deviation_at(std::span<const double> samples, double dt_s, double tau_s);

}  // namespace sim
