// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/autopilot_actuators.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "shoal/actuator_command_t.hpp"
#include "tests/devices/autopilot/autopilot_world.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace autopilot_world;

TEST(Autopilot, ABoatWithTwoPropellersGoesRoundItsWaypoints) {
  AutopilotWorld test(
      world_with("otter_autopilot.yaml",
                 "      devices.autopilot.waypoints: [{at_m: [30, 0], speed_mps: 1.5}, {at_m: [30, 30]}]\n"
                 "      devices.autopilot.at_end: stop\n",
                 "{water: {}}", 0));
  const auto state = test.state_after(90);
  EXPECT_EQ(state.finished, 1);
  EXPECT_EQ(state.mode, 1);
  EXPECT_NEAR(state.speed_error_mps, 0, 0.05);
  EXPECT_NEAR((test.place().head<2>() - Eigen::Vector2d(30, 30)).norm(), 0, 8);  // it stopped at the second
}

TEST(Autopilot, ABoatWhosePropellersPushAheadOnlyTurnsAndGoes) {
  AutopilotWorld test(world_with("otter_autopilot.yaml",
                                 "      devices.port.min: 0\n      devices.starboard.min: 0\n"
                                 "      devices.autopilot.hold: {speed_mps: 1, heading_deg: 170}\n",
                                 "{water: {}}", 0));
  const auto state = test.state_after(90);
  EXPECT_NEAR(state.heading_error_rad, 0, 0.02);
  EXPECT_NEAR(state.speed_error_mps, 0, 0.02);
}

TEST(Autopilot, ReckonsWithTheDensityOfItsFins) {
  const auto rudder_of = [](const std::string& keys) {
    AutopilotWorld test(R"(
shoal: 1
physics: {step_s: 0.01}
medium: {water: {}}
vehicles:
  - name: v
    position_m: [0, 0, -10]
    model:
      shoal: 1
      vehicle: auv
      bodies: [{name: hull, hydrodynamics: {mass_kg: 30, inertia_kgm2: [0.2, 4, 4]}, parts: [{shape: sphere, radius_m: 0.1}]}]
      devices:
        - {name: propeller, type: thruster, position_m: [-0.8, 0, 0]}
        - {name: rudder, type: fin, position_m: [-0.7, 0, 0], area_m2: 0.5)" +
                        keys + R"(}
        - {name: elevator, type: fin, position_m: [-0.7, 0, 0], rpy_deg: [90, 0, 0], area_m2: 0.5)" +
                        keys + R"(}
        - {name: autopilot, type: autopilot, thrusters: [propeller], fins: [rudder, elevator], hold: {heading_deg: 1}}
)");
    test::Listener<shoal::actuator_command_t> rudder(test, "v.rudder.cmd");
    test.run_for(0.15);
    return rudder.last().value;
  };
  const double plain = rudder_of("");
  ASSERT_NE(plain, 0);
  ASSERT_LT(std::abs(plain), 0.2) << "not at its limit";
  EXPECT_NEAR(rudder_of(", density_kgpm3: 2050") / plain, 0.5, 1e-9);
}

TEST(Autopilot, SwitchedOffItLeavesTheActuatorsToOthers) {
  AutopilotWorld test(world_with("remus100_survey.yaml", "      devices.autopilot.mode: 'off'\n"));
  test::Listener<shoal::actuator_command_t> commands(test, "v.propeller.cmd");
  EXPECT_EQ(test.state_after(2).mode, 0);
  EXPECT_TRUE(commands.take_all().empty());
  test.send("v.propeller.cmd", shoal::actuator_command_t{0, 1000});
  test.run_for(30);
  EXPECT_GT(test.world.find_vehicle("v")->base().v_WB_W().x(), 1);
  commands.take_all();
  test.mode(1);
  test.run_for(1);
  EXPECT_EQ(commands.take_all().size(), 10u);  // its rate is 10 Hz
  test.mode(0);
  test.run_for(1);
  commands.take_all();
  test.run_for(1);
  EXPECT_TRUE(commands.take_all().empty());
}

}  // namespace
