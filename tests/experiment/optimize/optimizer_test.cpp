// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/optimize/optimizer.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "experiment/optimize/cma_es.hpp"
#include "experiment/optimize/genetic.hpp"
#include "tests/experiment/optimize/functions_to_optimize.hpp"

namespace {

using namespace functions_to_optimize;

// Bounds: 1.5 times the medians when this was written, 1286, 5566 and 5789.  Ten coordinates and a linear convergence
// of the usual rate need about as many.

std::unique_ptr<experiment::Optimizer> made(bool genetic, std::uint64_t seed) {
  // A start in a corner and large steps: most samples are outside of the box.
  if (genetic)
    return std::make_unique<experiment::GeneticAlgorithm>(
        experiment::Point(5, 0.0), experiment::GeneticAlgorithm::Options{.sigma = 2, .seed = seed});
  return std::make_unique<experiment::CmaEs>(experiment::Point(5, 0.0),
                                             experiment::CmaEs::Options{.sigma = 1, .seed = seed});
}

std::vector<experiment::Point> course(bool genetic, std::uint64_t seed) {
  const auto optimizer = made(genetic, seed);
  std::vector<experiment::Point> all;
  for (int generation = 0; generation < 20; ++generation) {
    std::vector<double> values;
    for (experiment::Point& point : optimizer->propose()) {
      values.push_back(-sphere(point));
      all.push_back(std::move(point));
    }
    optimizer->learn(values);
  }
  return all;
}

TEST(Optimizers, KeepTheirPointsInTheBox) {
  for (const bool genetic : {false, true})
    for (const experiment::Point& point : course(genetic, 1))
      for (const double x : point) EXPECT_TRUE(x >= 0 && x <= 1) << x;
}

TEST(Optimizers, ASeedGivesTheSameCourse) {
  for (const bool genetic : {false, true}) {
    EXPECT_EQ(course(genetic, 7), course(genetic, 7));
    EXPECT_NE(course(genetic, 7), course(genetic, 8));
  }
}

TEST(Optimizers, ReflectAtBothSidesOfTheBox) {
  EXPECT_DOUBLE_EQ(experiment::reflected(0.25), 0.25);
  EXPECT_DOUBLE_EQ(experiment::reflected(-0.25), 0.25);
  EXPECT_DOUBLE_EQ(experiment::reflected(1.25), 0.75);
  EXPECT_DOUBLE_EQ(experiment::reflected(-3.75), 0.25);
  EXPECT_DOUBLE_EQ(experiment::reflected(2.25), 0.25);
}

TEST(Optimizers, RankEqualValuesByTheirPlace) {
  EXPECT_EQ(experiment::by_rank(std::vector<double>{1, 3, 3, 2}), (std::vector<std::size_t>{1, 2, 3, 0}));
}

}  // namespace
