// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/optimize/optimizer.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace experiment {

double reflected(double x) {
  const double in_period = x - 2 * std::floor(x / 2);  // 0 to 2
  return in_period <= 1 ? in_period : 2 - in_period;
}

std::vector<std::size_t> by_rank(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] > values[b]; });
  return order;
}

}  // namespace experiment
