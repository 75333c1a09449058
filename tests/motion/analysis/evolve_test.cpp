// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/evolve.hpp"

#include <gtest/gtest.h>

#include "tests/motion/analysis/evolve_fixture.hpp"

namespace {

using namespace evolve_fixture;

TEST(Evolution, TheBestIsTheSameForAnyNumberOfThreads) {
  Studio studio;
  studio.options.candidates = 8;
  std::vector<motion::Candidate> best;
  for (const int threads : {1, 2}) {
    studio.options.threads = threads;
    motion::Evolution evolution = studio.evolution();
    while (evolution.advance()) {
    }
    best.push_back(evolution.best_of_generation());
  }
  EXPECT_EQ(best[0].number, best[1].number);
  EXPECT_EQ(best[0].values, best[1].values);
  EXPECT_EQ(best[0].value_mps, best[1].value_mps);
  for (std::size_t w = 0; w < 2; ++w) EXPECT_EQ(best[0].walks[w]->state_hash, best[1].walks[w]->state_hash);
}

TEST(Evolution, TwentyCandidatesAreNotWorseThanTheStart) {
  for (const auto method : {motion::SearchMethod::cma_es, motion::SearchMethod::genetic}) {
    Studio studio;
    studio.options.method = method;
    studio.options.candidates = 20;
    studio.options.population = 10;
    motion::Evolution evolution = studio.evolution();
    while (evolution.advance()) {
    }
    EXPECT_EQ(evolution.tried(), 20);
    // The start in both worlds; of each ten candidates all in one world, and five in the other.
    EXPECT_EQ(evolution.walks(), 2 + 2 * (10 + 5));
    EXPECT_GE(evolution.best().value_mps, evolution.start().value_mps);
    EXPECT_TRUE(evolution.best().is_complete());
    // Its value is that of its worst world, and another walk is the same.
    const auto again = evolution.walks_of_best(evolution.perturbations());
    double worst_mps = 1;
    for (const motion::Walk& walk : again) worst_mps = std::min(worst_mps, walk.value_mps);
    EXPECT_EQ(worst_mps, evolution.best().value_mps);
    EXPECT_EQ(again[1].state_hash, evolution.best().walks[1]->state_hash);
  }
}

}  // namespace
