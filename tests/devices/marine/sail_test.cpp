// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/sail.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/devices/marine/marine_fixture.hpp"

namespace {

using devices::Sail;
using test::wet_device;
using test::WetBox;
using testing::HasSubstr;

// A box that moves in still air stands for the wind: 5 m above the water.
const char* above_water = "{water: {surface_m: -5}}";
using test::degree;

const char* keys = "type: sail, area_m2: 2, lift_slope: 4, drag_coefficient: 0.05, stall_deg: 18, rate_degps: 1e6";

sim::Vector3d force(double sheet_rad, const sim::Vector3d& wind_W) {
  WetBox box(wet_device(keys), above_water);
  box.command(sheet_rad);
  box.set_velocity(-wind_W);
  return box.force_W();
}

TEST(Sail, DrivesForwardWithTheWindOnTheBeamAsAWingAtItsAngleOfAttack) {
  // Wind from port; the boom goes to starboard until the sheet of 80 degrees stops it: 10 degrees of attack.
  const double a = 10 * degree, C_L = 4 * a, q_A = 0.5 * 1.225 * 36 * 2;
  const sim::Vector3d F = force(80 * degree, {0, -6, 0});
  EXPECT_NEAR(F.x(), q_A * C_L, 1e-8);  // lift is across the wind: forward
  EXPECT_NEAR(F.y(), -q_A * (0.05 + C_L * C_L / (std::numbers::pi * 0.9 * 4)), 1e-8);
  const sim::Vector3d from_starboard = force(80 * degree, {0, 6, 0});
  EXPECT_NEAR(from_starboard.x(), F.x(), 1e-9);
  EXPECT_NEAR(from_starboard.y(), -F.y(), 1e-9);
}

TEST(Sail, BeforeTheWindItIsAPlateAndInTheWindItOnlyDrags) {
  const double q_A = 0.5 * 1.225 * 25 * 2;
  EXPECT_NEAR(force(85 * degree, {5, 0, 0}).x(), q_A * (0.05 + 1.2 * std::pow(std::sin(85 * degree), 3)), 1e-8);
  const sim::Vector3d luffing = force(30 * degree, {-5, -1, 0});
  const double speed_square = 26;
  EXPECT_NEAR((luffing - 0.5 * 1.225 * std::sqrt(speed_square) * 2 * 0.05 * sim::Vector3d(-5, -1, 0)).norm(), 0, 1e-8);
}

TEST(Sail, IsLetOutWhenItsCommandsAreStale) {
  WetBox box(wet_device("type: sail, watchdog_s: 0.05, rate_degps: 1e6"), above_water);
  box.command(0.1);
  box.run_for(0.02);
  EXPECT_NEAR(box.device<Sail>().sheet_rad(), 0.1, 1e-12);
  box.run_for(0.1);
  EXPECT_NEAR(box.device<Sail>().sheet_rad(), 85 * degree, 1e-12);
}

TEST(Sail, SaysWhatIsWrongWithItsParameters) {
  const auto error = [](const std::string& more) { return test::error_of_device("type: sail, " + more); };
  EXPECT_THAT(error("area_m2: 0"), HasSubstr("'area_m2' must be > 0"));
  EXPECT_THAT(error("initial_deg: 90, limit_deg: 60"), HasSubstr("'initial_deg' must be at most 'limit_deg'"));
  EXPECT_EQ(error("area_m2: 3"), "");
}

}  // namespace
