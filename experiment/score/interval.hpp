// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace experiment {

/// 95 % confidence interval of a value, estimated from a sample of runs.
struct Interval {
  double low = 0, high = 0;
};

/// Returns the 97.5 % quantile of Student's t distribution; `degrees` of freedom are at least 1.
double student_t_975(std::size_t degrees);

/// Returns the interval of a mean: mean -/+ t std / sqrt(count).  `std`: of the sample (n - 1); `count` is at least 2.
/// Assumes a normally distributed mean, which holds for a skewed figure from about 30 runs on.
Interval mean_interval_95(double mean, double std, std::size_t count);

/// Returns the interval of a proportion, `hits` of `count` runs, by the score method (Wilson 1927): it stays within 0
/// and 1, and has a non-zero width when all or none hit.  `count` is at least 1.
Interval share_interval_95(std::size_t hits, std::size_t count);

/// Returns the probability that at most `heads` of n tosses of a fair coin are heads.
double fair_coin_share(std::size_t n, std::size_t heads);

/// Returns the interval of a median between two of the values: the closest pair of order statistics of the same rank
/// from both ends that encloses it with a probability of at least 95 %, for any distribution (David and Nagaraja, Order
/// Statistics, section 7.1).  `sorted` in ascending order; NaN for fewer than six values, of which no pair does.
Interval median_interval_95(const std::vector<double>& sorted);

}  // namespace experiment
