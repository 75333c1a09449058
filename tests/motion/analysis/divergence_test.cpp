// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/divergence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/world_file/load_world.hpp"

namespace {

constexpr double gravity_mps2 = 9.80665;

/// An arm of 0.5 m without weight holds 1 kg level, by a servo of 1.2 times the torque that this needs.
sim::WorldConfig loaded_arm() {
  const std::string effort = std::to_string(1.2 * gravity_mps2 * 0.5);
  return sim::load_world_text(R"(shoal: 1
physics: {step_s: 0.002, gravity_mps2: 9.80665}
vehicles:
  - name: arm
    position_m: [0.5, 0, 2]
    model:
      shoal: 1
      vehicle: arm
      bodies:
        - {name: hand, parts: [{shape: sphere, radius_m: 0.05, mass_kg: 1}]}
      joints:
        - {name: shoulder, type: hinge, bodies: [hand, world], anchor_m: [-0.5, 0, 0], axis: [0, 1, 0]}
      devices:
        - {name: shoulder, type: joint_servo, joint: shoulder, kp: 40, max_velocity: 0.2, max_effort: )" +
                                  effort + R"(}
        - {name: group, type: joint_group}
        - {name: player, type: motion_player, group: group}
)",
                              "arm.yaml")
      .config;
}

sim::JointMotion held_level() {
  sim::JointMotion motion;
  motion.name = "level";
  motion.keys.resize(2);
  motion.keys[1].at_s = 1;
  for (sim::MotionKey& key : motion.keys) key.joints = {{"shoulder", 0}};
  return motion;
}

motion::DivergenceOptions options_with_threads(int threads) {
  motion::DivergenceOptions options;
  options.duration_s = 3;
  options.row_s = 0.02;
  options.threads = threads;
  return options;
}

TEST(Divergence, IsThatOfTheModelThatIsTooWeakAndOfNoOther) {
  const motion::Divergence divergence =
      motion::divergence_of(loaded_arm(), "arm", held_level(), options_with_threads(1));
  ASSERT_EQ(divergence.curves.size(), 5u);
  ASSERT_EQ(divergence.rows(), 151u);
  for (const motion::DivergenceCurve& curve : divergence.curves) {
    EXPECT_LT(curve.fell_s, 0) << curve.model;
    const double greatest_m = *std::max_element(curve.distance_m.begin(), curve.distance_m.end());
    if (curve.model != "effort -20 %") {
      // 10 % more mass needs 1.1 of the 1.2.  Constraints are not quite stiff.
      EXPECT_LT(greatest_m, 1e-4) << curve.model;
      continue;
    }
    // 0.96 of the torque: the hand sinks until gravity has done as much work as the servo, m g r sin(a) = 0.96 m g r a,
    // a = 0.4929 rad.  1 %: rows, and the order of the integration.
    EXPECT_NEAR(greatest_m, 2 * 0.5 * std::sin(0.4929 / 2), 0.01 * 0.245);
  }
  EXPECT_LT(divergence.greatest_m(0), 1e-5);  // a step has passed
  EXPECT_LT(divergence.median_m(150), 1e-4);
  EXPECT_NEAR(divergence.greatest_until_m(150), 2 * 0.5 * std::sin(0.4929 / 2), 0.01 * 0.245);
}

TEST(Divergence, IsTheSameForAnyNumberOfThreads) {
  const motion::Divergence one = motion::divergence_of(loaded_arm(), "arm", held_level(), options_with_threads(1));
  const motion::Divergence two = motion::divergence_of(loaded_arm(), "arm", held_level(), options_with_threads(2));
  for (std::size_t i = 0; i < one.curves.size(); ++i)
    EXPECT_EQ(one.curves[i].distance_m, two.curves[i].distance_m) << one.curves[i].model;
}

}  // namespace
