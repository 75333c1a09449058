// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "devices/motion/joint_group.hpp"
#include "tests/devices/joint/leg_fixture.hpp"
#include "tests/devices/motion/joint_group_fixture.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace joint_group_fixture;

TEST(JointGroup, LimitsAJointByAnother) {
  const std::string limits =
      ", limits: [{joint: knee, by: hip, from_deg: -90, low_deg: -10}, {joint: knee, by: hip, from_deg: 10, low_deg: "
      "-5, high_deg: 20}]}\n";
  test::TestWorld test(test::leg_world("        - {name: group, type: joint_group" + limits));
  constexpr double deg = 0.017453292519943295;
  test.send("dog.group.cmd", frames({"hip", "knee"}, {{0, -30 * deg}}));
  test.run_for(0.05);
  EXPECT_NEAR(set_point(test, "knee"), -10 * deg, 1e-12);
  test.send("dog.group.cmd", frames({"hip"}, {{12 * deg}}));
  test.run_for(0.05);
  EXPECT_NEAR(set_point(test, "knee"), -5 * deg, 1e-12);
  test.send("dog.group.cmd", frames({"knee"}, {{40 * deg}}));
  test.run_for(0.05);
  EXPECT_NEAR(set_point(test, "knee"), 20 * deg, 1e-12);
  EXPECT_GT(group_of(test).counts().clipped, 0);
}

}  // namespace
