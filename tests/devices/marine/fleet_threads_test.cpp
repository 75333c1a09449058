// SPDX-License-Identifier: BSD-3-Clause
// A fleet whose vehicles threads share: the run is that of one thread.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "shoal/actuator_command_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/comms/modem_fixture.hpp"

namespace {

struct Hashes {
  std::vector<std::uint64_t> runs;  ///< after each step
  std::uint64_t state = 0;
  bool operator==(const Hashes&) const = default;
};

std::string fleet(const std::string& file, int count, const std::string& medium, double z_m) {
  return "shoal: 1\nphysics: {step_s: 0.01}\nmedium: " + medium +
         "\nvehicles:\n  - name: auv\n    count: " + std::to_string(count) + "\n    position_m: [0, 0, " +
         std::to_string(z_m) + "]\n    placement: {pattern: grid, spacing_m: 6}\n    file: " + file + "\n";
}

/// Steps a world; in the middle some modems speak, so that their vehicles act in turn.
Hashes run_of(const std::string& yaml, int threads, int steps, const std::string& modem = "") {
  test::TestWorld test(yaml);
  test.world.use_threads(threads);
  Hashes hashes;
  for (int step = 0; step < steps; ++step) {
    if (!modem.empty() && step % 20 == 5)
      for (const char* name : {"auv3", "auv77", "auv140"})
        test.send(name + ("." + modem + ".cmd"), test::bytes_to("hello"));
    test.world.step();
    hashes.runs.push_back(test.world.state().run_hash());
  }
  hashes.state = test.world.state().hash();
  return hashes;
}

void expect_equal_runs(const std::string& yaml, int steps, const std::string& modem = "") {
  const Hashes one = run_of(yaml, 1, steps, modem);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(run_of(yaml, threads, steps, modem), one) << threads << " threads";
}

const char* const sea = "{water: {}, current: [{velocity_mps: [0.2, 0.1, 0]}]}";

TEST(FleetThreads, RunAUVsByCoefficientsAsOneThreadDoes) {
  expect_equal_runs(fleet("remus100_nav.yaml", 150, sea, -20), 120, "modem");
}

TEST(FleetThreads, RunNaiveAUVsAsOneThreadDoes) {
  expect_equal_runs(fleet("naive_auv.yaml", 200, sea, -20), 120);
}

TEST(FleetThreads, RunFloatingBodiesAsOneThreadDoes) {
  const std::string boxes =
      "shoal: 1\nphysics: {step_s: 0.01}\nmedium: {water: {}, waves: {type: regular, height_m: 0.3, period_s: 4}}\n"
      "vehicles:\n  - name: box\n    count: 150\n    placement: {pattern: grid, spacing_m: 3}\n"
      "    model: {shoal: 1, vehicle: box, bodies: [{name: hull, parts: [{shape: box, size_m: [1, 0.6, 0.4], "
      "mass_kg: 100}]}], devices: [{name: imu, type: imu, rate_hz: 50, gyro_noise: {gaussian_std: 0.01}}]}\n";
  expect_equal_runs(boxes, 100);
}

TEST(FleetThreads, RunRoversAsOneThreadDoes) {
  const std::string rovers =
      "shoal: 1\nphysics: {step_s: 0.01}\nobjects: [{name: ground, fixed: true, parts: [{shape: plane}]}]\n"
      "vehicles:\n  - name: rover\n    count: 140\n    placement: {pattern: grid, spacing_m: 3}\n    file: "
      "rover.yaml\n";
  expect_equal_runs(rovers, 60);
}

/// The fault is that of the first vehicle in device order, and the state is the same.
TEST(FleetThreads, ReportTheFaultOfTheFirstVehicle) {
  const auto fault_with = [](int threads) {
    test::TestWorld test(fleet("remus100_nav.yaml", 150, sea, -20));
    test.world.use_threads(threads);
    test.run_for(0.1);
    for (const char* name : {"auv120", "auv31", "auv90"}) {
      const sim::Vehicle* vehicle = test.world.find_vehicle(name);
      vehicle->body("hull").set_velocity_W({1e200, 0, 0}, {0, 0, 0});
    }
    std::string text;
    try {
      test.run_for(0.1);
    } catch (const std::exception& error) {
      text = error.what();
    }
    return std::pair(text, test.world.state().hash());
  };
  const auto one = fault_with(1);
  EXPECT_NE(one.first.find("auv31/"), std::string::npos) << one.first;
  for (const int threads : {2, 3, 8}) EXPECT_EQ(fault_with(threads), one) << threads << " threads";
}

}  // namespace
