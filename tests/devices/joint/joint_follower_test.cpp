// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/joint_servo_command_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

/// A gripper on a table: two fingers on sliders, and a flap on a hinge.
std::string gripper_world(const std::string& devices) {
  return R"(shoal: 1
vehicles:
  - name: g1
    model:
      shoal: 1
      vehicle: gripper
      bodies:
        - {name: palm, parts: [{shape: box, size_m: [0.1, 0.1, 0.1], mass_kg: 1}]}
        - {name: left, position_m: [0.1, 0.05, 0], parts: [{shape: box, size_m: [0.1, 0.02, 0.02], mass_kg: 0.05}]}
        - {name: right, position_m: [0.1, -0.05, 0], parts: [{shape: box, size_m: [0.1, 0.02, 0.02], mass_kg: 0.05}]}
        - {name: flap, position_m: [0, 0, 0.1], parts: [{shape: box, size_m: [0.1, 0.02, 0.02], mass_kg: 0.05}]}
      joints:
        - {name: mount, type: fixed, bodies: [palm, world]}
        - {name: lead, type: slider, bodies: [palm, left], axis: [0, 1, 0], low_stop: -0.04, high_stop: 0.04}
        - {name: follow, type: slider, bodies: [palm, right], axis: [0, -1, 0]}
        - {name: hinge, type: hinge, bodies: [palm, flap], axis: [0, 0, 1]}
      devices:
        - {name: servo, type: joint_servo, joint: lead, max_velocity: 0.1, max_effort: 20}
)" + devices;
}

constexpr const char* followers =
    "        - {name: finger, type: joint_follower, joint: follow, follows: lead}\n"
    "        - {name: flap, type: joint_follower, joint: hinge, follows: lead, multiplier: -20, offset: 0.2}\n";

const sim::Joint& joint_of(test::TestWorld& test, const std::string& name) {
  return test.world.find_vehicle("g1")->joint(name);
}

void send_position(test::TestWorld& test, double position) {
  shoal::joint_servo_command_t command{};
  command.mode = 0;
  command.position = position;
  test.send("g1.servo.cmd", command);
}

TEST(JointFollower, KeepsAMultipleOfTheOtherPosition) {
  test::TestWorld test(gripper_world(followers));
  test.run_for(0.5);
  EXPECT_NEAR(joint_of(test, "hinge").position(), 0.2, 1e-4);  // the offset
  send_position(test, 0.03);
  for (int i = 0; i < 10; ++i) {  // also on the way, at 0.1 m/s
    test.run_for(0.02);
    EXPECT_NEAR(joint_of(test, "follow").position(), joint_of(test, "lead").position(), 1e-4);
    EXPECT_NEAR(joint_of(test, "hinge").position(), 0.2 - 20 * joint_of(test, "lead").position(), 20 * 1e-4);
  }
  test.run_for(1);
  EXPECT_NEAR(joint_of(test, "follow").position(), 0.03, 1e-4);
  EXPECT_NEAR(joint_of(test, "hinge").position(), 0.2 - 20 * 0.03, 1e-3);
}

TEST(JointFollower, HasLimitsOfEffortAndVelocity) {
  // Its weight is across the sliders.  0.05 kg at 0.01 N: 0.2 m/s^2, so that after 0.1 s it is at most at 1 mm.
  test::TestWorld weak(gripper_world(
      "        - {name: finger, type: joint_follower, joint: follow, follows: lead, max_effort: 0.01}\n"));
  send_position(weak, 0.03);
  weak.run_for(0.1);
  EXPECT_NEAR(joint_of(weak, "follow").position(), 0.001, 2e-4);
  test::TestWorld slow(gripper_world(
      "        - {name: finger, type: joint_follower, joint: follow, follows: lead, max_velocity: 0.01}\n"));
  send_position(slow, 0.03);
  slow.run_for(1);
  EXPECT_NEAR(joint_of(slow, "follow").position(), 0.01, 5e-4);
}

TEST(JointFollower, TakesAChangeOfItsMultiplier) {
  test::TestWorld test(gripper_world(followers));
  send_position(test, 0.03);
  test.run_for(0.1);
  ASSERT_EQ(test.change("g1/finger", "{multiplier: 0.5}"), "");
  test.run_for(1);
  EXPECT_NEAR(joint_of(test, "follow").position(), 0.015, 1e-4);
}

TEST(JointFollower, RefusesToFollowItself) {
  try {
    test::TestWorld test(gripper_world("        - {name: f, type: joint_follower, joint: lead, follows: lead}\n"));
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("joint 'lead' cannot follow itself"));
  }
}

}  // namespace
