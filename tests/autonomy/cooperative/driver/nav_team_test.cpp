// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/cooperative/driver/nav_team.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "autonomy/cooperative/driver/vehicle_reports.hpp"
#include "tests/autonomy/cooperative/driver/nav_team_fixture.hpp"

namespace {

using namespace nav_team_fixture;
using namespace navigation;

TEST(NavTeam, HasTheVehiclesWithAnAcousticModem) {
  const NavTeam team = team_with("");
  ASSERT_EQ(team.vehicles.size(), 1U);
  EXPECT_EQ(team.index_of("auv"), 0);
  EXPECT_EQ(team.index_of("buoy"), std::nullopt);
  EXPECT_EQ(team.vehicles[0].modem->channel, "auv.modem");
  EXPECT_EQ(team.vehicles[0].modem_command, "auv.modem.cmd");
  EXPECT_EQ(team.vehicles[0].synchronous_s, 2);
}

TEST(NavTeam, TakesErrorsFromTheDevices) {
  const NavTeam team = team_with(
      "{name: dvl, type: dvl, rate_hz: 5, scale_std: 0.03, velocity_noise: {gaussian_std: 0.02}},"
      "{name: ahrs, type: ahrs, heading_noise: {bias_std: 0.05, gauss_markov_std: 0.02, gauss_markov_time_s: 20}},"
      "{name: gps, type: gps, horizontal_noise: {gaussian_std: 1, gauss_markov_std: 2, gauss_markov_time_s: 300}}",
      "tcxo");
  const NavVehicle& auv = team.vehicles[0];
  EXPECT_EQ(auv.errors.heading_bias_rad, 0.05);
  EXPECT_EQ(auv.errors.slow_heading_rad, 0.02);
  EXPECT_EQ(auv.errors.slow_heading_time_s, 20);
  EXPECT_EQ(auv.errors.speed_scale, 0.03);
  EXPECT_NEAR(auv.velocity_density, 0.02 * 0.02 / 5, 1e-12);
  EXPECT_EQ(auv.fix_std_m, 1);
  EXPECT_EQ(auv.errors.slow_fix_m, 2);
  EXPECT_EQ(auv.errors.clock_s, 0.005);
  EXPECT_GE(auv.errors.clock_drift, 1e-6);
  // Beams at 30 degrees: 2, 2 and 1/3 of the variance of a beam.
  EXPECT_NEAR(auv.velocity_share, 2 / (4 + 1.0 / 3), 1e-12);
}

TEST(NavTeam, ASatelliteClockHasNoErrorAndAPerfectOneNeither) {
  EXPECT_EQ(team_with("{name: gps, type: gps, disciplines_clock: true}", "tcxo").vehicles[0].errors.clock_s, 0);
}

TEST(NavTeam, AWorldWithoutModemsIsRefused) {
  EXPECT_THROW(team_of_text("shoal: 1\nname: dry\n"), std::invalid_argument);
}

TEST(NavTeam, AHeadingThatTurnsNoVelocityHasItsErrorsInTheSights) {
  const NavVehicle craft = usbl_team("{bias_std: 0.05, gauss_markov_std: 0.02}").vehicles[0];
  EXPECT_EQ(craft.errors.heading_bias_rad, 0);
  EXPECT_EQ(craft.errors.slow_heading_rad, 0);
  EXPECT_EQ(craft.usbl_errors.across_std_rad, 0.04);
  EXPECT_NEAR(craft.usbl_errors.heading_std_rad, std::hypot(0.05, 0.02), 1e-12);
}

}  // namespace
