// SPDX-License-Identifier: BSD-3-Clause
#include "sim/device/fault.hpp"

#include <gmock/gmock.h>

#include "shoal/imu_t.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/arm_rover.hpp"
#include "tests/devices/joint/arm_fixture.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace arm_rover;

using sim::FaultKind;

TEST(ActuatorFault, DeadGivesNoForceAndComesBackWithItsCommand) {
  test::TestWorld test(test::arm_world(motor(), 0));
  turn(test, 1);
  test.run_for(0.1);
  test.world.editor().set_fault("a1/motor", {.kind = FaultKind::dead});
  test.run_for(0.1);
  EXPECT_EQ(shoulder(test).motor_max_force(), 0);
  test.world.editor().clear_faults("a1/motor");
  test.run_for(0.01);
  EXPECT_EQ(shoulder(test).motor_max_force(), 50);
  EXPECT_EQ(shoulder(test).motor_velocity(), 1);
}

TEST(ActuatorFault, PartialFaultsMultiply) {
  test::TestWorld test(test::arm_world(motor(), 0));
  test.world.editor().set_fault("a1/motor", {.kind = FaultKind::partial, .effectiveness = 0.4});
  test.run_for(0.01);
  EXPECT_EQ(shoulder(test).motor_max_force(), 0.4 * 50);
  test.world.editor().set_fault("a1/motor", {.kind = FaultKind::dead});
  test.run_for(0.01);
  EXPECT_EQ(shoulder(test).motor_max_force(), 0);
}

TEST(ActuatorFault, StuckKeepsItsLastCommandWhateverComes) {
  test::TestWorld test(test::arm_world(motor(", watchdog_s: 0.05"), 0));
  turn(test, 1);
  test.run_for(0.02);
  test.world.editor().set_fault("a1/motor", {.kind = FaultKind::stuck});
  turn(test, -2);
  for (const double velocity : targets(test, 200)) ASSERT_EQ(velocity, 1);
}

TEST(ActuatorFault, SilentReceivesNothingSoThatItsWatchdogStopsIt) {
  test::TestWorld test(test::arm_world(motor(", watchdog_s: 0.05"), 0));
  turn(test, 1);
  test.run_for(0.02);
  test.world.editor().set_fault("a1/motor", {.kind = FaultKind::silent});
  turn(test, -2);
  const auto velocities = targets(test, 100);
  EXPECT_EQ(velocities.front(), 1);
  EXPECT_EQ(velocities.back(), 0);
}

TEST(ActuatorFault, DegradedLosesCommands) {
  test::TestWorld test(test::arm_world(motor(), 0));
  test.world.editor().set_fault("a1/motor", {.kind = FaultKind::degraded, .dropout = 1});
  turn(test, 1);
  test.run_for(0.02);
  EXPECT_EQ(shoulder(test).motor_velocity(), 0);
}

const char* errors =
    ", gyro_noise: {gaussian_std: 0.02, gauss_markov_std: 0.01}, accel_noise: {gaussian_std: 0.1}, "
    "gyro_arw_deg_per_sqrt_h: 1, gyro_bias_instability_deg_per_h: 100, "
    "gyro_rate_random_walk_deg_per_h_per_sqrt_h: 50";

/// A box at rest with an IMU, and what it reported in three stretches of `stretch_s`: before, with and after a fault.
struct Stretches {
  std::vector<shoal::imu_t> before, during, after;
};

Stretches run(const std::optional<sim::FaultConfig>& fault, double stretch_s = 1, const std::string& noise = errors) {
  test::TestWorld test(test::box_world("        - {name: imu, type: imu, rate_hz: 100, phase_s: 0" + noise + "}\n",
                                       "{step_s: 0.01, gravity_mps2: 0}"));
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  Stretches result;
  test.run_for(stretch_s);
  result.before = reports.take_all();
  if (fault) test.world.editor().set_fault("r1/imu", *fault);
  test.run_for(stretch_s);
  result.during = reports.take_all();
  if (fault) test.world.editor().clear_faults("r1/imu");
  test.run_for(stretch_s);
  result.after = reports.take_all();
  return result;
}

sim::FaultConfig fault_of(sim::FaultKind kind) {
  sim::FaultConfig fault;
  fault.kind = kind;
  return fault;
}

void expect_equal(const std::vector<shoal::imu_t>& a, const std::vector<shoal::imu_t>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(shoal::encode(a[i]), shoal::encode(b[i])) << i;
}

TEST(SensorFault, ABiasShiftsItsQuantityByExactlyThat) {
  sim::FaultConfig fault = fault_of(sim::FaultKind::biased);
  fault.quantity = "gyro";
  fault.bias = 0.5;
  const Stretches sound = run({}), faulty = run(fault);
  ASSERT_EQ(sound.during.size(), faulty.during.size());
  for (std::size_t i = 0; i < sound.during.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(faulty.during[i].angular_velocity_radps[axis] - sound.during[i].angular_velocity_radps[axis], 0.5,
                  1e-15);
      EXPECT_EQ(faulty.during[i].linear_acceleration_mps2[axis], sound.during[i].linear_acceleration_mps2[axis]);
    }
}

TEST(SensorFault, ThreeTimesTheNoiseIsNineTimesTheVariance) {
  sim::FaultConfig fault = fault_of(sim::FaultKind::degraded);
  fault.noise_factor = 3;
  const std::string white = ", gyro_noise: {gaussian_std: 0.02}, accel_noise: {gaussian_std: 0.1}";
  const Stretches faulty = run(fault, 20, white);
  const auto variance = [](const std::vector<shoal::imu_t>& reports) {
    double squares = 0;
    for (const auto& report : reports)
      for (const double w : report.angular_velocity_radps) squares += w * w;
    return squares / (3 * static_cast<double>(reports.size()));
  };
  // The ratio of two estimates with n values each scatters by its value times sqrt(4 / n).
  const double n = 3.0 * static_cast<double>(faulty.during.size());
  EXPECT_NEAR(variance(faulty.during) / variance(faulty.before), 9, 4 * 9 * std::sqrt(4 / n));
  // Draw by draw it is the same error, three times as large.
  const Stretches sound = run({}, 20, white);
  for (std::size_t i = 0; i < sound.during.size(); ++i)
    EXPECT_NEAR(faulty.during[i].angular_velocity_radps[0], 3 * sound.during[i].angular_velocity_radps[0], 1e-15);
}

TEST(SensorFault, TheErrorsOfTheDataSheetAreDegradedToo) {
  sim::FaultConfig fault = fault_of(sim::FaultKind::degraded);
  fault.quantity = "gyro";
  fault.noise_factor = 3;
  const std::string sheet =
      ", gyro_arw_deg_per_sqrt_h: 1, gyro_bias_instability_deg_per_h: 100, accel_vrw_mps_per_sqrt_h: 1";
  const Stretches faulty = run(fault, 1, sheet), sound = run({}, 1, sheet);
  for (std::size_t i = 0; i < sound.during.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(faulty.during[i].angular_velocity_radps[axis], 3 * sound.during[i].angular_velocity_radps[axis],
                  1e-15);
      EXPECT_EQ(faulty.during[i].linear_acceleration_mps2[axis], sound.during[i].linear_acceleration_mps2[axis]);
    }
}

TEST(SensorFault, AStuckSensorRepeatsItselfWithARunningTime) {
  const Stretches faulty = run(fault_of(sim::FaultKind::stuck)), sound = run({});
  ASSERT_EQ(faulty.during.size(), sound.during.size());
  for (std::size_t i = 0; i < faulty.during.size(); ++i) {
    shoal::imu_t expected = sound.during[0];
    expected.utime = sound.during[i].utime;
    EXPECT_EQ(shoal::encode(faulty.during[i]), shoal::encode(expected)) << i;
  }
}

TEST(SensorFault, ASilentSensorSendsNothing) {
  const Stretches faulty = run(fault_of(sim::FaultKind::silent));
  EXPECT_EQ(faulty.before.size(), 100u);
  EXPECT_TRUE(faulty.during.empty());
  EXPECT_EQ(faulty.after.size(), 100u);
}

TEST(SensorFault, AfterAFaultTheMeasurementsAreThoseOfARunWithout) {
  const Stretches sound = run({});
  for (const sim::FaultKind kind :
       {sim::FaultKind::stuck, sim::FaultKind::silent, sim::FaultKind::biased, sim::FaultKind::degraded}) {
    sim::FaultConfig fault = fault_of(kind);
    if (kind == sim::FaultKind::biased) fault.bias = 0.3;
    if (kind == sim::FaultKind::degraded) {
      fault.noise_factor = 3;
      fault.dropout = 0.5;
    }
    const Stretches faulty = run(fault);
    expect_equal(faulty.before, sound.before);
    expect_equal(faulty.after, sound.after);
  }
}

}  // namespace
