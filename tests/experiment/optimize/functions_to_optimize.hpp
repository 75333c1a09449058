// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "experiment/optimize/cma_es.hpp"
#include "experiment/optimize/genetic.hpp"
#include "experiment/optimize/optimizer.hpp"

namespace functions_to_optimize {

using Function = std::function<double(const experiment::Point&)>;

/// Point of the optimum, away from the center of the box.
inline double optimum(std::size_t i) {
  return 0.3 + 0.04 * static_cast<double>(i);
}

inline double sphere(const experiment::Point& x) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += std::pow(x[i] - optimum(i), 2);
  return sum;
}

/// Returns the evaluations until the cost is below `target`; `max_count` when it never is.
inline int evaluations(experiment::Optimizer& optimizer, const Function& cost, double target, int max_count) {
  int count = 0;
  while (count < max_count) {
    const std::vector<experiment::Point> points = optimizer.propose();
    std::vector<double> values;
    for (const experiment::Point& point : points) {
      ++count;
      const double one = cost(point);
      if (one < target) return count;
      values.push_back(-one);
    }
    optimizer.learn(values);
  }
  return max_count;
}

}  // namespace functions_to_optimize
