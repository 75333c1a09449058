// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/optimize/genetic.hpp"

#include <gtest/gtest.h>

#include "experiment/optimize/cma_es.hpp"
#include "experiment/optimize/optimizer.hpp"
#include "tests/experiment/optimize/functions_to_optimize.hpp"

namespace {

using namespace functions_to_optimize;

TEST(GeneticAlgorithm, FindsTheOptimumOfASphere) {
  // 1e-3 is 0.01 in each of ten coordinates.  538 evaluations when this was written.
  experiment::GeneticAlgorithm optimizer(experiment::Point(10, 0.5), {});
  EXPECT_LT(evaluations(optimizer, sphere, 1e-3, 20000), 810);
}

}  // namespace
