// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/evolve.hpp"

#include <gtest/gtest.h>

#include "tests/project_paths.hpp"

namespace {

struct Studio {
  sim::WorldConfig world = sim::load_world(test_support::source_path("worlds/ers7_studio.yaml")).config;
  std::unique_ptr<motion::GaitFamily> gait = motion::make_gait("half_ellipse", *world.vehicles.front().config);
  motion::EvolveOptions options;

  Studio() {
    options.population = 4;
    options.worlds = 2;
    options.walk = {.warm_up_s = 0.2, .measured_s = 0.5};
    options.threads = 2;
  }
  motion::Evolution evolution() const { return {world, "dog", *gait, options}; }
};

TEST(Walk, ASlowTrotGoesForward) {
  Studio studio;
  studio.options.worlds = 0;
  studio.options.walk = {};
  const motion::Candidate start = studio.evolution().start();
  ASSERT_EQ(start.walks.size(), 1u);
  EXPECT_FALSE(start.walks[0]->fell);
  // It can be at most as fast as its feet on the ground: the length in half of 0.704 s.
  const double foot_mps = start.values[6] / 0.352;
  EXPECT_GT(start.walks[0]->forward_mps, 0);
  EXPECT_LT(start.walks[0]->forward_mps, 1.2 * foot_mps);
}

TEST(Walk, AVehicleOnItsBellyHasFallen) {
  Studio studio;
  sim::JointMotion spread;
  spread.name = "spread";
  spread.loop = true;
  spread.start.max_velocity = 2;
  // Legs to the side: the torso lies on the ground.
  spread.keys.resize(2);
  spread.keys[1].at_s = 1;
  for (const char* joint : {"lf_flap", "rf_flap", "lh_flap", "rh_flap"})
    for (sim::MotionKey& key : spread.keys) key.joints.emplace_back(joint, 1.5);
  const motion::Walk walk =
      motion::measured_walk(motion::world_for_walks(studio.world), "dog", spread, studio.options.walk);
  EXPECT_TRUE(walk.fell);
  EXPECT_LE(walk.value_mps, -0.1);
  EXPECT_GE(walk.value_mps, -0.3);
}

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
