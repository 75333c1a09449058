// SPDX-License-Identifier: BSD-3-Clause
#include "devices/power/battery.hpp"

#include <gmock/gmock.h>

#include "shoal/battery_t.hpp"
#include "shoal/joint_command_t.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "tests/devices/joint/arm_fixture.hpp"

namespace {

std::string battery(const std::string& more) {
  return "        - {name: battery, type: battery, rate_hz: every_step" + more + "}\n";
}

const std::string wheels = "left_joint: left, right_joint: right";

TEST(Battery, TenWattsEmptyAHundredthOfAWattHourIn3Point6Seconds) {
  test::TestWorld test(test::rover_world("        - {name: lamp, type: odometry, " + wheels + ", power_W: 10}\n" +
                                         battery(", capacity_Wh: 0.01")));
  test::Listener<shoal::battery_t> reports(test, "r1.battery");
  const auto& systems = test.world.find_vehicle("r1")->systems();
  test.run_for(1.8);
  const auto half = reports.last();
  EXPECT_NEAR(half.charge, 0.5, 1e-9);
  EXPECT_NEAR(half.energy_J, 18, 1e-6);
  EXPECT_NEAR(half.voltage_V, 11.8, 1e-6);  // half way between 11 and 12.6 V
  EXPECT_NEAR(half.current_A, 10 / 11.8, 1e-3);
  EXPECT_EQ(half.empty, 0);
  test.run_for(1.799);
  EXPECT_TRUE(systems.powered);
  test.run_for(0.001);
  EXPECT_FALSE(systems.powered);
  const auto last = reports.last();
  EXPECT_EQ(last.empty, 1);
  EXPECT_EQ(last.energy_J, 0);
}

TEST(Battery, EmptyTheMotorsStopAndTheSensorsFallSilent) {
  test::TestWorld test(test::rover_world("        - {name: drive, type: differential_drive, " + wheels +
                                         ", wheel_radius_m: 0.1, track_m: 0.5, power_W: 36}\n" +
                                         "        - {name: odometry, type: odometry, " + wheels + ", rate_hz: 100}\n" +
                                         battery(", capacity_Wh: 0.02")));
  test::Listener<shoal::odometry_t> odometry(test, "r1.odometry");
  test::Listener<shoal::battery_t> reports(test, "r1.battery");
  shoal::twist_command_t command{};
  command.forward_mps = 0.5;
  test.send("r1.drive.cmd", command);
  test.run_for(3);  // 72 J: at 36 W and what the motors take it lasts less than 2 s
  const sim::Vehicle& rover = *test.world.find_vehicle("r1");
  EXPECT_EQ(rover.joint("left").motor_max_force(), 0);
  const auto received = odometry.take_all();
  ASSERT_FALSE(received.empty());
  EXPECT_LT(static_cast<double>(received.back().utime - test.world.epoch_us()) * 1e-6, 2.0);
  EXPECT_EQ(reports.last().empty, 1);  // it needs no power to say so
  test.send("r1.drive.cmd", command);
  test.run_for(0.5);
  EXPECT_EQ(rover.joint("left").motor_max_force(), 0);
}

TEST(Battery, GivesTheMotorsWhatTheirWorkTakes) {
  // Raising the arm by 0.3 rad from level takes m g l sin(0.3) of work, at an efficiency of 0.5.
  test::TestWorld test(
      test::arm_world("        - {name: motor, type: joint_motor, joint: shoulder, max_force: 100, efficiency: 0.5}\n" +
                      battery(", capacity_Wh: 1, open_circuit_V: [12]")));
  test.run_for(0.1);
  test::Listener<shoal::battery_t> reports(test, "a1.battery");
  shoal::joint_command_t up{};
  up.velocity = -0.1;
  test.send("a1.motor.cmd", up);
  test.run_for(3);
  const double work_J = test::arm_mass_kg * 9.80665 * test::arm_length_m * std::sin(0.3);
  // The motor jerks the arm to 0.1 rad/s in one step: that takes I w^2, half of it in the contact of the gears.  The
  // meter is a step of 1 mJ/0.5 behind.
  const double jerk_J = test::arm_inertia_kgm2 * 0.1 * 0.1;
  EXPECT_NEAR(3600 - reports.last().energy_J, (work_J + jerk_J - 9.80665e-4) / 0.5, 1e-3);
}

TEST(Battery, ItsVoltageFallsUnderLoadAndItsHeatIsPaidToo) {
  test::TestWorld test(
      test::rover_world("        - {name: lamp, type: odometry, " + wheels + ", power_W: 27}\n" +
                        battery(", open_circuit_V: [12], internal_resistance_ohm: 1, capacity_Wh: 1")));
  test::Listener<shoal::battery_t> reports(test, "r1.battery");
  test.run_for(1);
  const auto report = reports.last();
  EXPECT_NEAR(report.current_A, 3, 1e-9);  // 12 I - I^2 = 27
  EXPECT_NEAR(report.voltage_V, 9, 1e-9);
  EXPECT_NEAR(3600 - report.energy_J, 36, 1e-6);
}

TEST(Battery, MoreThanItCanGiveBreaksItsVoltageDown) {
  test::TestWorld test(test::rover_world("        - {name: lamp, type: odometry, " + wheels + ", power_W: 50}\n" +
                                         battery(", open_circuit_V: [12], internal_resistance_ohm: 1")));
  test::Listener<shoal::battery_t> reports(test, "r1.battery");
  test.run_for(0.1);
  EXPECT_NEAR(reports.last().voltage_V, 6, 1e-9);  // at most 12^2 / 4 = 36 W
}

TEST(Battery, FollowsATableOfVoltages) {
  for (const auto& [charge, volts] :
       std::vector<std::pair<const char*, double>>{{"1", 12.6}, {"0.75", 12.1}, {"0.5", 11.6}, {"0.25", 10.6}}) {
    test::TestWorld test(
        test::rover_world(battery(std::string(", open_circuit_V: [9.6, 11.6, 12.6], initial_charge: ") + charge)));
    test::Listener<shoal::battery_t> reports(test, "r1.battery");
    test.run_for(0.01);
    EXPECT_NEAR(reports.last().voltage_V, volts, 1e-9) << charge;
  }
}

TEST(Battery, NoiseHasTheSpreadAskedFor) {
  test::TestWorld test(test::rover_world(battery(
      ", initial_charge: 0.5, truth: true, voltage_noise: {gaussian_std: 0.05}, charge_noise: {gaussian_std: 0.02}")));
  test::Listener<shoal::battery_t> reports(test, "r1.battery"), truths(test, "r1.battery.truth");
  test.run_for(4);
  const auto measured = reports.take_all(), truth = truths.take_all();
  double volts = 0, charge = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    volts += std::pow(measured[i].voltage_V - truth[i].voltage_V, 2);
    charge += std::pow(measured[i].charge - truth[i].charge, 2);
  }
  const auto count = static_cast<double>(truth.size());
  // Four standard deviations of the estimate.
  EXPECT_NEAR(std::sqrt(volts / count), 0.05, 4 * 0.05 / std::sqrt(2 * count));
  EXPECT_NEAR(std::sqrt(charge / count), 0.02, 4 * 0.02 / std::sqrt(2 * count));
}

TEST(Battery, ThereIsOneInAVehicle) {
  try {
    test::TestWorld test(test::rover_world(battery("") + "        - {name: spare, type: battery}\n"));
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("vehicle 'r1': device 'spare': the vehicle already has a battery"));
  }
}

TEST(Battery, RefusesAnEmptyTable) {
  try {
    test::TestWorld test(test::rover_world(battery(", open_circuit_V: []")));
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("device 'battery': 'open_circuit_V' must have at least one voltage"));
  }
}

}  // namespace
