// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace tools {

/// Where a value of many runs lies, by those that were done, with 95 % confidence.
struct Interval {
  double low = 0, high = 0;
};

/// The quantile of Student's t distribution that leaves 2.5 % above it; `degrees` of freedom are at least 1.
double student_t_975(std::size_t degrees);

/// Of a mean: mean -/+ t std / sqrt(count).  `std`: of the sample (n - 1); `count` is at least 2.  It takes the mean
/// for normal, which that of a skewed figure is from some 30 runs on.
Interval mean_interval_95(double mean, double std, std::size_t count);

/// Of a share, `hits` of `count` runs, by Wilson's score: it stays within 0 and 1, and has a non-zero width when all
/// or none hit.  `count` is at least 1.
Interval share_interval_95(std::size_t hits, std::size_t count);

}  // namespace tools
