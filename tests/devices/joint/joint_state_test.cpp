// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/joint_state_t.hpp"
#include "tests/devices/joint/arm_fixture.hpp"

namespace {

TEST(JointState, ReportsPositionsVelocitiesAndEfforts) {
  // A motor without a command holds the arm level, against m g l = 9.80665 N m.
  test::TestWorld test(
      test::arm_world("        - {name: servo, type: joint_motor, joint: shoulder, max_force: 50}\n"
                      "        - {name: joints, type: joint_state, rate_hz: every_step}\n"));
  test::Listener<shoal::joint_state_t> reports(test, "a1.joints");
  test.run_for(0.2);
  const auto report = reports.last();
  ASSERT_EQ(report.num_joints, 1);
  EXPECT_EQ(report.joint_name[0], "shoulder");
  EXPECT_NEAR(report.joint_position[0], 0, 1e-6);
  EXPECT_NEAR(report.joint_velocity[0], 0, 1e-6);
  EXPECT_NEAR(report.joint_effort[0], -9.80665,
              1e-3);  // upwards is negative; softness of the hinge, floats on the wire
}

TEST(JointState, ListsAllJointsInTheOrderOfTheFileOrTheOnesAskedFor) {
  for (const std::string keys : {"", ", joints: [right]"}) {
    test::TestWorld test(test::rover_world("        - {name: joints, type: joint_state" + keys + "}\n"));
    test::Listener<shoal::joint_state_t> reports(test, "r1.joints");
    test.run_for(0.1);
    const std::vector<std::string> all = {"left", "right"}, one = {"right"};
    EXPECT_EQ(reports.last().joint_name, keys.empty() ? all : one);
  }
}

TEST(JointState, MeasuringDoesNotChangeTheRun) {
  const auto end = [](const std::string& devices) {
    test::TestWorld test(test::arm_world(devices));
    test.run_for(1);
    return test.world.find_vehicle("a1")->joint("shoulder").position();
  };
  EXPECT_EQ(end("        - {name: joints, type: joint_state}\n"), end("        []\n"));
}

TEST(JointState, NoiseHasTheSpreadAskedForAndTruthHasNone) {
  test::TestWorld test(
      test::arm_world("        - {name: motor, type: joint_motor, joint: shoulder, max_force: 50}\n"
                      "        - {name: joints, type: joint_state, rate_hz: every_step, truth: true, position_noise: "
                      "{gaussian_std: 0.01},\n"
                      "           velocity_noise: {gaussian_std: 0.02}, effort_noise: {gaussian_std: 0.5}}\n"));
  test::Listener<shoal::joint_state_t> reports(test, "a1.joints"), truths(test, "a1.joints.truth");
  test.run_for(4);
  const auto measured = reports.take_all(), truth = truths.take_all();
  ASSERT_EQ(measured.size(), 4000u);
  ASSERT_EQ(truth.size(), 4000u);
  double squares[3] = {};
  for (std::size_t i = 0; i < truth.size(); ++i) {
    squares[0] += std::pow(measured[i].joint_position[0] - truth[i].joint_position[0], 2);
    squares[1] += std::pow(measured[i].joint_velocity[0] - truth[i].joint_velocity[0], 2);
    squares[2] += std::pow(measured[i].joint_effort[0] - truth[i].joint_effort[0], 2);
  }
  const double expected[] = {0.01, 0.02, 0.5};
  // Four standard deviations of the estimate.
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(std::sqrt(squares[i] / 4000), expected[i], 4 * expected[i] / std::sqrt(2 * 4000.0)) << i;
  EXPECT_NEAR(truth.back().joint_position[0], 0, 1e-6);
}

TEST(JointState, RefusesAVehicleWithoutJoints) {
  std::string world = test::arm_world("        - {name: joints, type: joint_state}\n");
  world.replace(world.find("type: hinge"), 11, "type: ball");
  world.replace(world.find(", axis: [0, 1, 0]"), 17, "");
  try {
    test::TestWorld test(world);
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("device 'joints': the vehicle has no joint with an axis"));
  }
}

}  // namespace
