// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "devices/joint/joint_servo.hpp"
#include "shoal/joint_command_t.hpp"
#include "tests/devices/joint/arm_fixture.hpp"
#include "tests/devices/joint/joint_servo_fixture.hpp"

namespace {

using namespace joint_servo_fixture;

TEST(JointServo, TakesTheVelocityCommandOfAJointMotorToo) {
  test::TestWorld test(test::arm_world(servo(", max_effort: 50")));
  shoal::joint_command_t message{};
  message.velocity = 0.3;
  test.send("a1.servo.cmd", message);
  test.run_for(0.5);
  EXPECT_NEAR(shoulder(test).velocity(), 0.3, 1e-4);
  EXPECT_EQ(test.world.counts().bad_messages, 0);
}

TEST(JointServo, IgnoresAModeThatDoesNotExist) {
  test::TestWorld test(test::arm_world(servo(", max_effort: 50")));
  command(test, 7, 1);
  test.run_for(0.2);
  EXPECT_EQ(test.world.counts().bad_messages, 1);
  EXPECT_NEAR(shoulder(test).position(), 0, 1e-6);
}

}  // namespace
