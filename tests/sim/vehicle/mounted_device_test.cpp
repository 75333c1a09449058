// SPDX-License-Identifier: BSD-3-Clause
// What the framework does around every device: watchdog, latencies, losses, faults, power.
#include "sim/vehicle/mounted_device.hpp"

#include <gmock/gmock.h>

#include <bit>

#include "shoal/joint_state_t.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/arm_rover.hpp"
#include "tests/devices/joint/arm_fixture.hpp"

namespace {

using namespace arm_rover;

sim::VehicleSystems& systems(test::TestWorld& test) {
  return test.world.vehicles().front()->systems();
}

TEST(Watchdog, ACommandIsGoodForExactlyItsTime) {
  test::TestWorld test(test::arm_world(motor(", watchdog_s: 0.05")));
  test.run_for(0.01);
  turn(test, 1);
  const auto velocities = targets(test, 100);
  // Taken at 10 ms, it is 50 ms old in the step that begins at 60 ms, and older in the next.
  for (std::size_t i = 0; i <= 50; ++i) EXPECT_EQ(velocities[i], 1) << i;
  for (std::size_t i = 51; i < 100; ++i) EXPECT_EQ(velocities[i], 0) << i;
}

TEST(Watchdog, EveryCommandStartsItsTimeAgainAndTheNextOneEndsTheSafeState) {
  test::TestWorld test(test::arm_world(motor(", watchdog_s: 0.05")));
  for (int i = 0; i < 5; ++i) {
    turn(test, 1);
    for (const double velocity : targets(test, 40)) EXPECT_EQ(velocity, 1);
  }
  targets(test, 40);
  EXPECT_EQ(shoulder(test).motor_velocity(), 0);
  turn(test, 2);
  EXPECT_EQ(targets(test, 1)[0], 2);
}

TEST(Watchdog, WaitsForTheFirstCommand) {
  test::TestWorld test(test::arm_world(motor(", watchdog_s: 0.05, safe: coast")));
  test.run_for(0.2);
  EXPECT_EQ(shoulder(test).motor_max_force(), 50);  // it has held since the start
  turn(test, 0);
  test.run_for(0.2);
  EXPECT_EQ(shoulder(test).motor_max_force(), 0);  // it coasts
}

TEST(Watchdog, ABadCommandIsNone) {
  test::TestWorld test(test::arm_world(motor(", watchdog_s: 0.05")));
  turn(test, 1);
  test.run_for(0.04);
  test.bus.publish("a1.motor.cmd", sim::Bytes(20), test.world.now());
  test.run_for(0.02);
  EXPECT_EQ(shoulder(test).motor_velocity(), 0);
}

/// Position and velocity of the shoulder after each step; from rest, with a command before the first one.
std::vector<std::uint64_t> trajectory(const std::string& motor_keys, const std::string& vehicle_keys) {
  // Without gravity nothing moves until the command comes.
  std::string world = test::arm_world(motor(motor_keys), 0);
  world.insert(world.find("      vehicle: arm\n"), vehicle_keys);
  test::TestWorld test(world);
  turn(test, 1);
  std::vector<std::uint64_t> states;
  for (int i = 0; i < 300; ++i) {
    test.world.step();
    states.push_back(std::bit_cast<std::uint64_t>(shoulder(test).position()));
    states.push_back(std::bit_cast<std::uint64_t>(shoulder(test).velocity()));
  }
  return states;
}

TEST(ActuatorLatency, ShiftsTheWholeResponseByExactlyThatTime) {
  const auto prompt = trajectory("", "");
  ASSERT_NE(prompt[1], std::bit_cast<std::uint64_t>(0.0));
  const std::pair<const char*, const char*> ways[] = {{", latency_s: 0.02", ""},
                                                      {"", "      actuator_latency_s: 0.02\n"},
                                                      {", latency_s: 0.005", "      actuator_latency_s: 0.015\n"}};
  for (const auto& [device, vehicle] : ways) {
    const auto late = trajectory(device, vehicle);
    const std::size_t shift = 2 * 20;  // two numbers for each of 20 steps of 1 ms
    for (std::size_t i = 0; i < shift; ++i) ASSERT_EQ(std::bit_cast<double>(late[i]), 0) << device << vehicle << i;
    for (std::size_t i = shift; i < late.size(); ++i) ASSERT_EQ(late[i], prompt[i - shift]) << device << vehicle << i;
  }
}

TEST(ActuatorLatency, BetweenTwoStepsTakesEffectAtTheNextOne) {
  const auto late = trajectory(", latency_s: 0.0201", "");
  const auto next = trajectory(", latency_s: 0.021", "");
  EXPECT_EQ(late, next);
}

TEST(ActuatorLatency, DoesNotDelaySensorsOfTheVehicle) {
  std::string world = test::arm_world(motor() + joints(", rate_hz: 100, phase_s: 0"));
  world.insert(world.find("      vehicle: arm\n"), "      actuator_latency_s: 0.5\n");
  test::TestWorld test(world);
  test::Listener<shoal::joint_state_t> reports(test, "a1.joints");
  test.run_for(0.1);
  EXPECT_EQ(reports.take_all().size(), 10u);
}

TEST(SensorLatency, ReportsTheSameReadingsLater) {
  // How many reports have come after each step.
  const auto run = [](const std::string& keys, std::vector<std::size_t>& received) {
    test::TestWorld test(test::arm_world(motor() + joints(", rate_hz: 100, phase_s: 0" + keys)));
    test::Listener<shoal::joint_state_t> reports(test, "a1.joints");
    turn(test, 1);
    std::vector<shoal::joint_state_t> all;
    for (int i = 0; i < 200; ++i) {
      test.world.step();
      for (auto& report : reports.take_all()) all.push_back(report);
      received.push_back(all.size());
    }
    return all;
  };
  std::vector<std::size_t> prompt_received, late_received;
  const auto prompt = run("", prompt_received), late = run(", latency_s: 0.02", late_received);
  for (std::size_t i = 0; i < 20; ++i) ASSERT_EQ(late_received[i], 0u) << i;
  for (std::size_t i = 20; i < 200; ++i) ASSERT_EQ(late_received[i], prompt_received[i - 20]) << i;
  for (std::size_t i = 0; i < late.size(); ++i) {
    ASSERT_EQ(late[i].utime, prompt[i].utime);  // of the sample, not of the report
    ASSERT_EQ(late[i].joint_position, prompt[i].joint_position);
  }
}

TEST(Jitter, LiesBetweenTheLatencyAndTheLatencyWithIt) {
  // A sample every 100 ms, a report 20 to 50 ms later: at the first step at or after its time.
  test::TestWorld test(test::arm_world(joints(", rate_hz: 10, phase_s: 0.001, latency_s: 0.02, jitter_s: 0.03")));
  test::Listener<shoal::joint_state_t> reports(test, "a1.joints");
  double sum_s = 0, min_s = 1, max_s = 0;
  int count = 0;
  while (count < 500) {
    test.world.step();
    for (const auto& report : reports.take_all()) {
      const double delay_s =
          sim::to_seconds(test.world.now()) - static_cast<double>(report.utime - test.world.epoch_us()) * 1e-6;
      min_s = std::min(min_s, delay_s);
      max_s = std::max(max_s, delay_s);
      sum_s += delay_s;
      ++count;
    }
  }
  EXPECT_GE(min_s, 0.02 - 1e-9);
  EXPECT_LE(max_s, 0.05 + 1e-9);
  EXPECT_LT(min_s, 0.022);  // 500 draws leave no gap of 2 ms (probability 1e-15)
  EXPECT_GT(max_s, 0.048);
  // The mean of a uniform number, half a step later; four standard deviations.
  EXPECT_NEAR(sum_s / count, 0.0355, 4 * 0.03 / std::sqrt(12.0 * count));
}

TEST(Dropout, LosesItsShareOfReportsAndCommands) {
  test::TestWorld test(test::arm_world(motor(", dropout: 0.3") + joints(", rate_hz: every_step, dropout: 0.2")));
  test::Listener<shoal::joint_state_t> reports(test, "a1.joints");
  int taken = 0;
  for (int i = 0; i < 5000; ++i) {
    const double velocity = 1e-6 * (i + 1);
    turn(test, velocity);
    test.world.step();
    if (shoulder(test).motor_velocity() == velocity) ++taken;
  }
  // Four standard deviations of a binomial share.
  EXPECT_NEAR(taken / 5000.0, 0.7, 4 * std::sqrt(0.3 * 0.7 / 5000));
  EXPECT_NEAR(static_cast<double>(reports.take_all().size()) / 5000.0, 0.8, 4 * std::sqrt(0.2 * 0.8 / 5000));
}

TEST(Power, WithoutItActuatorsAreFreeAndSensorsSilent) {
  test::TestWorld test(test::arm_world(motor() + joints(", rate_hz: 100"), 0));
  test::Listener<shoal::joint_state_t> reports(test, "a1.joints");
  turn(test, 1);
  test.run_for(0.1);
  EXPECT_EQ(reports.take_all().size(), 10u);
  systems(test).powered = false;
  test.run_for(0.1);
  EXPECT_EQ(shoulder(test).motor_max_force(), 0);
  EXPECT_TRUE(reports.take_all().empty());
  turn(test, 2);
  test.run_for(0.01);
  systems(test).powered = true;
  test.run_for(0.1);
  // It receives again, but what was sent before is lost, and it stays safe until it is commanded.
  EXPECT_EQ(shoulder(test).motor_velocity(), 0);
  EXPECT_EQ(shoulder(test).motor_max_force(), 50);
  EXPECT_FALSE(reports.take_all().empty());
}

TEST(Power, ACommandOnItsWayWhenItGoesIsLost) {
  test::TestWorld test(test::arm_world(motor(", latency_s: 0.05"), 0));
  turn(test, 1);
  test.run_for(0.01);
  systems(test).estopped = true;
  test.run_for(0.1);
  systems(test).estopped = false;
  test.run_for(0.1);
  EXPECT_EQ(shoulder(test).motor_velocity(), 0);
}

}  // namespace
