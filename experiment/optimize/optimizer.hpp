// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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
double reflected(double x);

/// Returns the numbers of the values in descending order; of equal values the first one comes first.
std::vector<std::size_t> by_rank(std::span<const double> values);

}  // namespace experiment
