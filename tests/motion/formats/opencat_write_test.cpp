// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <numbers>

#include "motion/formats/skill_array.hpp"
#include "tests/motion/formats/format_fixture.hpp"

namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180;

TEST(OpencatFormat, WritesABehaviorWithSpeedsAndDelays) {
  const sim::JointMotion motion = test::motion({{0, {{"lf_swing", 0}, {"lf_knee", 30.4 * degree}}},
                                                {0.4, {{"lf_swing", 40 * degree}}, sim::Easing::cosine},
                                                {0.9, {{"lf_swing", 40 * degree}}}});
  const test::Written file = test::written("opencat", motion, test::leg_names());
  // 40 degrees in 0.4 s, which is 20 steps of 20 ms: 2 degrees a step.  0.5 s are 10 delays.
  EXPECT_EQ(file.bytes,
            "// behavior of OpenCat, 2 rows\nconst int8_t wave[] PROGMEM = {\n  -2, 0, 0, 1,\n  0, 0, 0,\n"
            "  0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 30, 0, 0, 0, 8, 0, 0, 0,\n"
            "  0, 0, 0, 0, 0, 0, 0, 0, 40, 0, 0, 0, 30, 0, 0, 0, 8, 10, 0, 0,\n};\n");
  EXPECT_THAT(file.losses, ElementsAre(HasSubstr("joints that the motion does not name are at 0: 0, 1"),
                                       "angles are rounded to whole degrees"));
  const sim::JointMotion again = test::read("opencat", file.bytes, test::leg_names()).motion;
  EXPECT_DOUBLE_EQ(again.end_s(), 0.9);
  EXPECT_NEAR(test::value(again, "lf_swing", 0.1), 40 * degree * (1 - std::numbers::sqrt2 / 2) / 2, 1e-12)
      << "a cosine";
  EXPECT_NEAR(test::value(again, "lf_knee", 0.5), 30 * degree, 1e-12);
}

TEST(OpencatFormat, WritesALoopAsAGaitOfItsWalkingJoints) {
  sim::JointMotion motion = test::motion(
      {{0, {{"joint_8", 0}, {"joint_0", 1}}}, {0.04, {{"joint_8", 40 * degree}}}, {0.08, {{"joint_8", 0}}}});
  motion.loop = true;
  const test::Written file = test::written("opencat", motion);
  EXPECT_EQ(file.bytes,
            "// gait of OpenCat, 4 rows\nconst int8_t wave[] PROGMEM = {\n  4, 0, 0, 1,\n"
            "  0, 0, 0, 0, 0, 0, 0, 0,\n  20, 0, 0, 0, 0, 0, 0, 0,\n  40, 0, 0, 0, 0, 0, 0, 0,\n  20, 0, 0, 0, 0, 0, "
            "0, 0,\n};\n");
  EXPECT_THAT(file.losses, Contains("a gait has only joints 8 to 15: left out are joint_0"));
  const test::Read again = test::read("opencat", file.bytes);
  EXPECT_TRUE(again.motion.loop);
  EXPECT_DOUBLE_EQ(again.motion.end_s(), 0.08);
  EXPECT_NEAR(test::value(again.motion, "joint_8", 0.04), 40 * degree, 1e-12);
}

TEST(OpencatFormat, HalvesAnglesAbove127Degrees) {
  const test::Written file =
      test::written("opencat", test::motion({{0, {{"joint_9", -200 * degree}, {"joint_8", 31 * degree}}}}));
  EXPECT_THAT(file.bytes, HasSubstr("  1, 0, 0, 2,\n  0, 0, 0, 0, 0, 0, 0, 0, 16, -100, "));
  EXPECT_NEAR(test::value(test::read("opencat", file.bytes).motion, "joint_9", 0), -200 * degree, 1e-12);
}

TEST(OpencatFormat, RefusesWhatItCannotHold) {
  EXPECT_THAT(test::error_of([] {
                test::written("opencat", test::motion({{0, {{"knee", 0}}}}));
              }),
              HasSubstr("motion 'wave': joint 'knee' has no number from 0 to 15 in OpenCat"));
  EXPECT_THAT(test::error_of([] {
                test::written("opencat", test::motion({{0, {{"joint_3", 5}}}}));
              }),
              HasSubstr("joint 'joint_3': must be from -254 to 254 degrees, got 286.47"));
}

}  // namespace
