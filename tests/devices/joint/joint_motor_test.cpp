// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/joint_command_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

constexpr const char* motor =
    "        - {name: motor, type: joint_motor, joint: left, max_velocity: 3, max_force: 5}\n";

TEST(JointMotor, TurnsTheJointAtTheCommandedVelocity) {
  test::TestWorld test(test::rover_world(motor));
  shoal::joint_command_t command{};
  command.velocity = 2;
  test.send("r1.motor.cmd", command);
  test.run_for(1);
  EXPECT_NEAR(test.world.find_vehicle("r1")->joint("left").velocity(), 2, 0.02);
}

TEST(JointMotor, CutsACommandToItsLimit) {
  test::TestWorld test(test::rover_world(motor));
  shoal::joint_command_t command{};
  command.velocity = -100;
  test.send("r1.motor.cmd", command);
  test.run_for(0.1);
  EXPECT_EQ(test.world.find_vehicle("r1")->joint("left").motor_velocity(), -3);
}

TEST(JointMotor, AChangeOfItsLimitCutsTheStandingCommand) {
  test::TestWorld test(test::rover_world(motor));
  shoal::joint_command_t command{};
  command.velocity = 2;
  test.send("r1.motor.cmd", command);
  test.run_for(0.1);
  ASSERT_EQ(test.change("r1/motor", "{max_velocity: 1}"), "");
  test.run_for(0.1);
  EXPECT_EQ(test.world.find_vehicle("r1")->joint("left").motor_velocity(), 1);
}

TEST(JointMotor, NamesAJointThatDoesNotExist) {
  try {
    test::TestWorld test(test::rover_world("        - {name: motor, type: joint_motor, joint: lft}\n"));
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("device 'motor': 'joint' names no joint 'lft'; known joints: left, right"));
  }
}

}  // namespace
