// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/moving_mass.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "sim/world/world_editor.hpp"
#include "tests/devices/marine/marine_fixture.hpp"

namespace {

using devices::MovingMass;
using test::wet_device;
using test::WetBox;
using testing::HasSubstr;

const char* deep = "{water: {surface_m: 50}}";

TEST(MovingMass, ForwardsItTurnsTheNoseDownByItsWeightAndWay) {
  WetBox box(wet_device("type: moving_mass, mass_kg: 9, rate_mps: 100"), deep, 9.81);
  box.command(0.03);
  EXPECT_NEAR((box.torque_W() - sim::Vector3d(0, 9 * 9.81 * 0.03, 0)).norm(), 0, 1e-9);
}

TEST(MovingMass, ItsMomentIsThatOfItsWeightInEveryAttitude) {
  // Nose up by 60 degrees: half the arm is left.
  WetBox box(wet_device("type: moving_mass, mass_kg: 9, rate_mps: 100"), deep, 9.81);
  box.body.set_pose(sim::make_pose(sim::Vector3d::Zero(), {0, -std::numbers::pi / 3, 0}));
  box.command(0.03);
  EXPECT_NEAR((box.torque_W() - sim::Vector3d(0, 0.5 * 9 * 9.81 * 0.03, 0)).norm(), 0, 1e-9);
}

TEST(MovingMass, TurnedAboutItsAxisItRollsTheVehicle) {
  WetBox box(wet_device("type: moving_mass, motion: turn, mass_kg: 10, radius_m: 0.02, rate_degps: 1e6"), deep, 9.81);
  box.command(0.5);
  EXPECT_NEAR((box.torque_W() - sim::Vector3d(-10 * 9.81 * 0.02 * std::sin(0.5), 0, 0)).norm(), 0, 1e-9);
}

TEST(MovingMass, MovesNoFasterAndNoFartherThanItsLimits) {
  WetBox box(wet_device("type: moving_mass, max_m: 0.02, min_m: -0.01, rate_mps: 0.05"), deep, 9.81);
  box.command(1);
  box.run_for(0.2);
  EXPECT_NEAR(box.device<MovingMass>().place(), 0.01, 1e-12);
  box.run_for(1);
  EXPECT_NEAR(box.device<MovingMass>().place(), 0.02, 1e-12);
  box.command(-1);
  box.run_for(1);
  EXPECT_NEAR(box.device<MovingMass>().place(), -0.01, 1e-12);
}

TEST(MovingMass, StaysOrGoesBackWhenItsCommandsAreStaleAndStaysWhenDead) {
  for (const auto& [safe, place] : {std::pair{"hold", 0.005}, {"stop", 0.0}}) {
    WetBox box(wet_device("type: moving_mass, rate_mps: 1, watchdog_s: 0.0045, safe: " + std::string(safe)));
    box.command(0.04);
    box.run_for(0.5);
    EXPECT_NEAR(box.device<MovingMass>().place(), place, 1e-12) << safe;
  }
  WetBox dead(wet_device("type: moving_mass, rate_mps: 1"));
  dead.command(0.04);
  dead.run_for(0.1);
  dead.world.editor().set_fault("v/d", {.kind = sim::FaultKind::dead});
  dead.command(0);
  dead.run_for(0.1);
  EXPECT_NEAR(dead.device<MovingMass>().place(), 0.04, 1e-12);
}

TEST(MovingMass, SaysWhatIsWrongWithItsParameters) {
  const auto error = [](const std::string& keys) { return test::error_of_device("type: moving_mass, " + keys); };
  EXPECT_THAT(error("mass_kg: 0"), HasSubstr("'mass_kg' must be > 0"));
  EXPECT_THAT(error("min_m: 1"), HasSubstr("'min_m' must be"));
  EXPECT_THAT(error("motion: fall"), HasSubstr("'motion'"));
  EXPECT_EQ(error("max_m: 1"), "");
}

}  // namespace
