// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/push_trials.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "tests/scratch_folder.hpp"

namespace {

/// A block of 2 kg and 0.04 kg of feet that stands on four small feet at (+-0.15, +-0.1) m, its center of mass 0.3 m
/// above ground, with an arm without weight that a player moves.
struct Block {
  test_support::ScratchFolder folder;
  motion::StageOptions options;

  Block() {
    options.world = folder.file("world.yaml");
    std::string feet;
    for (const char* place : {"[0.15, 0.1, 0.01]", "[0.15, -0.1, 0.01]", "[-0.15, 0.1, 0.01]", "[-0.15, -0.1, 0.01]"})
      feet += std::string("            - {shape: sphere, radius_m: 0.01, mass_kg: 0.01, position_m: ") + place + "}\n";
    std::ofstream(options.world)
        << R"(shoal: 1
physics: {step_s: 0.002}
contacts: [{between: [any, any], friction: 5}]
objects:
  - {name: ground, fixed: true, parts: [{shape: plane}]}
vehicles:
  - name: block
    model:
      shoal: 1
      vehicle: block
      bodies:
        - name: top
          parts: [{shape: sphere, radius_m: 0.02, mass_kg: 2, position_m: [0, 0, 0.3]}]
        - name: base
          parts:
)" << feet
        << R"(        - {name: arm, position_m: [0, 0, 0.4], parts: [{shape: sphere, radius_m: 0.01, mass_kg: 1.0e-3}]}
      joints:
        - {name: frame, type: fixed, bodies: [top, base]}
        - {name: arm, type: hinge, bodies: [top, arm], anchor_m: [0, 0, 0.4], axis: [0, 0, 1]}
      devices:
        - {name: arm, type: joint_servo, joint: arm}
        - {name: group, type: joint_group}
        - {name: player, type: motion_player, group: group}
)";
  }
};

sim::JointMotion turn() {
  sim::JointMotion motion;
  motion.name = "turn";
  motion.keys = {{0, "", {{"arm", 0}}, {}, "", {}}, {2, "", {{"arm", 1}}, {}, "", {}}};
  return motion;
}

/// Impulse per mass at which the block tips over an edge at this distance.  An impulse J at the height of the ball, h,
/// turns the block about the edge at J h / I; this energy must lift its center of mass, at the height c, over the edge.
double tipping_mps(double r) {
  const double h = 0.3, mass_kg = 2.041;
  const double c = (2 * h + 0.04 * 0.01 + 0.001 * 0.4) / mass_kg;
  const double inertia_kgm2 = 2 * (r * r + h * h) + 0.02 * 4 * r * r;  // ball, and the two feet of the other side
  return std::sqrt(2 * inertia_kgm2 * mass_kg * 9.80665 * (std::hypot(r, c) - c)) / h / mass_kg;
}

TEST(PushTest, ABlockTipsAtTheImpulseOfItsEnergy) {
  const Block block;
  motion::MotionStage stage(block.options, turn());
  motion::PushOptions options;
  options.directions = 4;
  options.push_s = 0.002;
  options.greatest_mps = 2;
  options.watch_s = 3;
  const auto margins = motion::push_margins(stage, {1.0}, options);
  ASSERT_EQ(margins.size(), 1u);
  EXPECT_NEAR(margins[0].mass_kg, 2.041, 1e-4);
  // It tilts 45 degrees only beyond the top of its arc: tipping and falling are the same.  5 %: the soft ground gives
  // way, and the push is found to 1/64 m/s.
  for (int direction = 0; direction < 4; ++direction) {
    const double expected = tipping_mps(direction % 2 == 0 ? 0.15 : 0.1);
    EXPECT_NEAR(margins[0].withstood_mps[static_cast<std::size_t>(direction)], expected, 0.05 * expected) << direction;
  }
  EXPECT_NEAR(std::fmod(margins[0].least_direction_rad(), std::numbers::pi), std::numbers::pi / 2, 1e-9);
  EXPECT_GT(margins[0].settle_m, 0);
}

TEST(PushTest, TheWeakestPushIsTheLeastMarginWithFewerPushes) {
  const Block block;
  motion::PushOptions options;
  options.watch_s = 3;
  std::vector<double> weakest_mps;
  const std::vector<double> instants_s{0.5, 1.0, 1.5};
  for (const int threads : {1, 2}) {
    options.threads = threads;
    motion::MotionStage stage(block.options, turn());
    const motion::WeakestPush weakest = motion::weakest_push(stage, instants_s, options);
    EXPECT_FALSE(weakest.falls);
    EXPECT_FALSE(weakest.is_beyond);
    EXPECT_NEAR(weakest.mass_kg, 2.041, 1e-4);
    // Sideways, over the edges at 0.1 m.
    EXPECT_NEAR(std::fmod(weakest.direction_rad, std::numbers::pi), std::numbers::pi / 2, 1e-9);
    weakest_mps.push_back(weakest.withstood_mps);
  }
  EXPECT_EQ(weakest_mps[0], weakest_mps[1]);
  motion::MotionStage stage(block.options, turn());
  double least_Ns = 1e9;
  for (const motion::PushMargin& margin : motion::push_margins(stage, instants_s, options))
    least_Ns = std::min(least_Ns, margin.least_Ns());
  // Both are found to 1/64 m/s, between other pushes.
  EXPECT_NEAR(weakest_mps[0], least_Ns / 2.041, 2.0 / 64);
}

TEST(PushTest, TheWeakestPushKnowsWhatIsBeyondItsRange) {
  const Block block;
  motion::PushOptions options;
  options.watch_s = 0.5;
  options.greatest_mps = 0.25;  // it tips at 1.1 m/s
  motion::MotionStage stage(block.options, turn());
  const motion::WeakestPush weakest = motion::weakest_push(stage, {0.5}, options);
  EXPECT_TRUE(weakest.is_beyond);
  EXPECT_EQ(weakest.withstood_mps, 0.25);
}

TEST(PushTest, HasTheChangesOfTheMotionThatComeAfterThePush) {
  const Block block;
  motion::MotionStage stage(block.options, turn());
  stage.go_to(1.02);
  sim::Diagnostics diagnostics;
  stage.run_action(sim::parse_config_text("{gravity_mps2: 1}", "action", diagnostics));
  stage.go_to(2);
  motion::PushOptions options;
  options.directions = 1;
  options.push_s = 0.002;
  options.greatest_mps = 2;
  options.watch_s = 8;
  // From 20 ms on the energy to tip it is a tenth of before, and so the impulse a third; until then the weight of
  // before takes g t of an impulse at the edge, 0.15 m beside it, and so half of that 0.3 m above it.
  const double expected = tipping_mps(0.15) * std::sqrt(1 / 9.80665) + 9.80665 * 0.02 * 0.15 / 0.3;
  EXPECT_NEAR(motion::push_margins(stage, {1.0}, options)[0].withstood_mps[0], expected, 0.1 * expected);
}

TEST(PushTest, SettlesWhereItWouldBeWithoutAPush) {
  const Block block;
  motion::MotionStage stage(block.options, turn());
  motion::PushOptions options;
  options.directions = 1;
  options.watch_s = 0.5;
  options.settle_mps = 0;
  // The motion moves the block, but no push does.
  EXPECT_EQ(motion::push_margins(stage, {1.0}, options)[0].settle_m, 0);
}

TEST(PushTest, IsTheSameForAnyNumberOfThreadsAndLeavesTheWorldAlone) {
  const Block block;
  motion::PushOptions options;
  options.directions = 3;
  options.watch_s = 0.5;
  std::vector<std::vector<double>> results;
  std::uint64_t hash = 0;
  for (const int threads : {1, 2}) {
    motion::MotionStage stage(block.options, turn());
    options.threads = threads;
    for (const auto& margin : motion::push_margins(stage, {0.5, 1.5}, options)) {
      results.push_back(margin.withstood_mps);
      results.back().push_back(margin.settle_m);
    }
    stage.go_to(2.5);
    if (threads == 1) hash = stage.state_hash();
    EXPECT_EQ(stage.state_hash(), hash);
  }
  EXPECT_EQ(results[0], results[2]);
  EXPECT_EQ(results[1], results[3]);
  motion::MotionStage without_pushes(block.options, turn());
  without_pushes.go_to(2.5);
  EXPECT_EQ(without_pushes.state_hash(), hash);
}

}  // namespace
