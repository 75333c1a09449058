// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

namespace experiment {

/// Point of the search space: each coordinate from 0 to 1.
using Point = std::vector<double>;

/// Search for the point with the largest value, in generations: propose() for points, learn() their values.  Its random
/// numbers depend on the seed and the number of the candidate only.
class Optimizer {
 public:
  virtual ~Optimizer() = default;
  /// Returns the points of the next generation, all within the box.
  virtual std::vector<Point> propose() = 0;
  /// Takes the values of the points of the last propose(), in its order; greater is better, and all are finite.  Of
  /// equal values the first one is the better.
  virtual void learn(std::span<const double> values) = 0;
};

/// Returns a coordinate reflected at 0 and 1, as often as needed.
inline double reflected(double x) {
  const double in_period = x - 2 * std::floor(x / 2);  // 0 to 2
  return in_period <= 1 ? in_period : 2 - in_period;
}

/// Returns the numbers of the values in descending order; of equal values the first one comes first.
inline std::vector<std::size_t> by_rank(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] > values[b]; });
  return order;
}

}  // namespace experiment
