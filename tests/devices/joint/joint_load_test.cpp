// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/joint_servo_command_t.hpp"
#include "shoal/wrench_t.hpp"
#include "tests/devices/joint/arm_fixture.hpp"

namespace {

constexpr double weight_N = test::arm_mass_kg * 9.80665;

std::string load(const std::string& more) {
  return "        - {name: motor, type: joint_motor, joint: shoulder, max_force: 50}\n"
         "        - {name: load, type: joint_load, joint: shoulder, rate_hz: every_step" +
         more + "}\n";
}

TEST(JointLoad, CarriesAWeightOnALever) {
  test::TestWorld test(test::arm_world(load("")));
  test::Listener<shoal::wrench_t> reports(test, "a1.load");
  test.run_for(0.5);
  const auto report = reports.last();
  // What the joint applies on the arm: m g upwards, and about y the torque that turns +x up: -m g l.
  EXPECT_NEAR(report.force_N[0], 0, 1e-3);
  EXPECT_NEAR(report.force_N[1], 0, 1e-3);
  EXPECT_NEAR(report.force_N[2], weight_N, 1e-3);  // hinge softness
  EXPECT_NEAR(report.torque_Nm[1], -weight_N * test::arm_length_m, 1e-3);
}

TEST(JointLoad, MeasuresInTheFrameAskedFor) {
  // The sensor is rolled by 90 degrees: its y-axis points up and its z-axis to the right (-y).
  for (const std::string frame : {"sensor", "body", "world"}) {
    test::TestWorld test(test::arm_world(load(", rpy_deg: [90, 0, 0], frame: " + frame)));
    test::Listener<shoal::wrench_t> reports(test, "a1.load");
    test.run_for(0.5);
    const auto report = reports.last();
    EXPECT_NEAR(report.force_N[frame == "sensor" ? 1 : 2], weight_N, 1e-3) << frame;
    EXPECT_NEAR(frame == "sensor" ? -report.torque_Nm[2] : report.torque_Nm[1], -weight_N * test::arm_length_m, 1e-3)
        << frame;
  }
}

TEST(JointLoad, AHangingMassPullsAndDoesNotTurn) {
  test::TestWorld test(
      test::arm_world("        - {name: servo, type: joint_servo, joint: shoulder, max_effort: 50, max_velocity: 3}\n"
                      "        - {name: load, type: joint_load, joint: shoulder, rate_hz: every_step, frame: body}\n"));
  test::Listener<shoal::wrench_t> reports(test, "a1.load");
  shoal::joint_servo_command_t down{};
  down.position = std::numbers::pi / 2;
  test.send("a1.servo.cmd", down);
  test.run_for(3);
  const auto report = reports.last();
  // +x of the body points down, so that the joint pulls along -x.
  EXPECT_NEAR(report.force_N[0], -weight_N, 1e-3);
  EXPECT_NEAR(report.force_N[2], 0, 1e-3);
  EXPECT_NEAR(report.torque_Nm[1], 0, 1e-3);
}

TEST(JointLoad, NoiseHasTheSpreadAskedForOnEachAxis) {
  test::TestWorld test(
      test::arm_world(load(", truth: true, force_noise: {gaussian_std: 0.3}, torque_noise: {gaussian_std: 0.1}")));
  test::Listener<shoal::wrench_t> reports(test, "a1.load"), truths(test, "a1.load.truth");
  test.run_for(3);
  const auto measured = reports.take_all(), truth = truths.take_all();
  ASSERT_EQ(measured.size(), truth.size());
  const auto count = static_cast<double>(truth.size());
  for (int axis = 0; axis < 3; ++axis) {
    double force = 0, torque = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      force += std::pow(measured[i].force_N[axis] - truth[i].force_N[axis], 2);
      torque += std::pow(measured[i].torque_Nm[axis] - truth[i].torque_Nm[axis], 2);
    }
    // Four standard deviations of the estimate.
    EXPECT_NEAR(std::sqrt(force / count), 0.3, 4 * 0.3 / std::sqrt(2 * count)) << axis;
    EXPECT_NEAR(std::sqrt(torque / count), 0.1, 4 * 0.1 / std::sqrt(2 * count)) << axis;
  }
}

TEST(JointLoad, NamesAFrameThatDoesNotExist) {
  try {
    test::TestWorld test(test::arm_world(load(", frame: arm")));
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("device 'load': 'frame' must be one of: sensor, body, world"));
  }
}

}  // namespace
