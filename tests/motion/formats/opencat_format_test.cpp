// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/opencat_format.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "motion/formats/skill_array.hpp"
#include "tests/motion/formats/format_fixture.hpp"

namespace {

using testing::Contains;

constexpr double degree = std::numbers::pi / 180;

TEST(OpencatFormat, RepeatsTheLoopOfABehavior) {
  motion::SkillArray skill;
  skill.name = "hi";
  skill.period = -3;
  skill.loop_first = 1, skill.loop_last = 2, skill.loop_count = 2;
  for (const int angle : {0, 10, 20}) {
    motion::SkillRow& row = skill.rows.emplace_back();
    row.angles_deg[8] = angle;
    row.speed = 4;
  }
  const test::Read file = test::read("opencat", motion::skill_text(skill));
  // Rows 0 1 2 1 2 at 1 degree a step of 20 ms: four ways of 10 degrees.
  EXPECT_DOUBLE_EQ(file.motion.end_s(), 0.8);
  EXPECT_NEAR(test::value(file.motion, "joint_8", 0.6), 10 * degree, 1e-12);
  EXPECT_THAT(file.losses, Contains("the loop of the behavior is written 2 times"));
}

}  // namespace
