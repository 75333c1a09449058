// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/optimize/cma_es.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "experiment/optimize/genetic.hpp"
#include "experiment/optimize/optimizer.hpp"
#include "tests/experiment/optimize/functions_to_optimize.hpp"

namespace {

using namespace functions_to_optimize;

/// Axes of condition 1e6.
double ellipsoid(const experiment::Point& x) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum +=
        std::pow(10, 6.0 * static_cast<double>(i) / static_cast<double>(x.size() - 1)) * std::pow(x[i] - optimum(i), 2);
  return sum;
}

/// Rosenbrock's function of -2 to 2 in each coordinate; its optimum is at 1.
double rosenbrock(const experiment::Point& x) {
  double sum = 0;
  const auto at = [&](std::size_t i) { return 4 * x[i] - 2; };
  for (std::size_t i = 0; i + 1 < x.size(); ++i)
    sum += 100 * std::pow(at(i + 1) - at(i) * at(i), 2) + std::pow(1 - at(i), 2);
  return sum;
}

int median_evaluations(const Function& cost, std::size_t n, int max_count) {
  std::vector<int> counts;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    experiment::CmaEs optimizer(experiment::Point(n, 0.5), {.seed = seed});
    counts.push_back(evaluations(optimizer, cost, 1e-9, max_count));
  }
  std::nth_element(counts.begin(), counts.begin() + 2, counts.end());
  return counts[2];
}

TEST(CmaEs, FindsTheOptimumOfASphere) {
  EXPECT_LT(median_evaluations(sphere, 10, 20000), 1930);
}

TEST(CmaEs, LearnsTheAxesOfAnEllipsoid) {
  EXPECT_LT(median_evaluations(ellipsoid, 10, 20000), 8350);
}

TEST(CmaEs, FollowsTheValleyOfRosenbrock) {
  EXPECT_LT(median_evaluations(rosenbrock, 10, 20000), 8680);
}

TEST(CmaEs, FindsAnOptimumAtTheEdgeOfTheBox) {
  const auto towards_edge = [](const experiment::Point& x) {
    double sum = 0;
    for (const double one : x) sum += 1 - one;
    return sum;
  };
  experiment::CmaEs optimizer(experiment::Point(6, 0.5), {.population = 16});
  EXPECT_LT(evaluations(optimizer, towards_edge, 1e-2, 20000), 3000);
}

}  // namespace
