// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/walk.hpp"

#include <gtest/gtest.h>

#include "motion/analysis/evolve.hpp"
#include "tests/motion/analysis/evolve_fixture.hpp"

namespace {

using namespace evolve_fixture;

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

}  // namespace
