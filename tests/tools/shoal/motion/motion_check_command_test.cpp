// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "sim/motion/motion.hpp"
#include "tests/tools/shoal/called_command.hpp"
#include "tests/tools/shoal/motion/leg_files.hpp"

namespace {

using testing::HasSubstr;

TEST(MotionCheckCommand, PassesAMotionThatKeepsTheLimitsOfItsVehicle) {
  const test::LegFiles files;
  // 45 degrees in 1 s: 0.79 rad, below 1, at 0.79 rad/s, below 2.
  const test::Called called =
      test::call_shoal({"motion", "check", files.motion("bend", test::bend), "--vehicle", files.path("leg.yaml")});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_EQ(called.out, "motion keeps all limits of leg\n");
}

TEST(MotionCheckCommand, AFixedMotionKeepsTheLimitsAndTakesLonger) {
  const test::LegFiles files;
  const std::string fast = files.motion("fast", "[{at_s: 0, joints: {knee: 0}}, {at_s: 0.25, joints: {knee: 90}}]");
  const std::string slow = files.path("slow.yaml");
  const test::Called called =
      test::call_shoal({"motion", "check", fast, "--vehicle", files.path("leg.yaml"), "--fix", slow});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_THAT(called.out, HasSubstr("is above its upper limit, 57.30 deg"));
  EXPECT_THAT(called.out, HasSubstr("is faster than its servo, 114.59 deg/s"));
  // 1 rad at 2 rad/s takes 0.5 s, 63 whole frames of 8 ms.
  EXPECT_THAT(called.out, HasSubstr("slow.yaml written: 0.504 s instead of 0.250 s, 0 findings left\n"));
  const sim::JointMotion fixed = sim::load_motion(slow);
  EXPECT_EQ(fixed.name, "slow");
  EXPECT_NEAR(fixed.tracks().front().keys.back().value, 1, 1e-9);
}

}  // namespace
