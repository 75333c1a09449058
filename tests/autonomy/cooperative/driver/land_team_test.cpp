// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/land_team.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/autonomy/cooperative/driver/land_rovers.hpp"

namespace {

using namespace navigation;
using land_rovers::rovers;
using testing::HasSubstr;

TEST(LandTeam, HasTheVehiclesWithOdometryAndTheErrorsOfTheirDevices) {
  const NavTeam team = rovers();
  ASSERT_EQ(team.vehicles.size(), 2U);
  EXPECT_EQ(team.index_of("crate"), std::nullopt);
  const NavVehicle& rover = team.vehicles[0];
  EXPECT_EQ(rover.land->odometry.channel, "rover1.wheels");
  EXPECT_EQ(rover.modem_command, "rover1.radio.cmd");
  EXPECT_EQ(rover.land->seen_std_m, 0.1);
  EXPECT_EQ(rover.fix_std_m, 0.5);
  EXPECT_EQ(rover.errors.slow_fix_m, 2);
  EXPECT_EQ(rover.errors.slow_fix_time_s, 60);
  // 0.1 m radius and 0.01 rad at 10 Hz: each wheel has 0.001 m sqrt(10) in 1 s, and the wheels are 0.4 m apart.
  EXPECT_NEAR(rover.land->along_density, 0.001 * 0.001 * 10 / 2, 1e-12);
  EXPECT_NEAR(rover.errors.heading_walk_radprts, 0.001 * std::sqrt(2 * 10) / 0.4, 1e-9);
}

TEST(LandTeam, OfADataSetHasTheErrorsOfItsRobotsWhichDoNotSlideSideways) {
  const NavTeam team = land_team_of(world_of_text(
      "shoal: 1\nname: mrclam\nvehicles:\n  - {name: robot1, model: {shoal: 1, bodies: [{name: base, kinematic: true, "
      "parts: [{shape: cylinder, radius_m: 0.17, length_m: 0.1}]}]}}\n"));
  ASSERT_EQ(team.vehicles.size(), 1U);
  const NavVehicle& robot = team.vehicles[0];
  EXPECT_EQ(robot.land->odometry.channel, "robot1.odometry");
  // In 1 s 6 cm along the track, 3 mm across.
  EXPECT_NEAR(std::sqrt(robot.land->along_density), 0.06, 1e-12);
  EXPECT_NEAR(std::sqrt(robot.land->across_density), 0.003, 1e-12);
  EXPECT_EQ(robot.errors.heading_walk_radprts, 0.06);
}

TEST(LandTeam, OfNoVehicleItCanNavigateIsAnError) {
  try {
    land_team_of(
        world_of_text("shoal: 1\nname: store\nvehicles:\n  - name: crate\n    model: {shoal: 1, bodies: [{name: "
                      "box, parts: [{shape: box, size_m: [1, 1, 1], mass_kg: 1}]}], devices: [{name: clock, "
                      "type: clock}]}\n"));
    FAIL() << "it has a team";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("world 'store' has no vehicle that shoal-nav can navigate: vehicle 'crate'"));
  }
}

}  // namespace
