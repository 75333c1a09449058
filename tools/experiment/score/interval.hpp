// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace tools {

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

}  // namespace tools
