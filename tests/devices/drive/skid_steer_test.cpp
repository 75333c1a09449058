// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/skid_steer.hpp"

#include <gmock/gmock.h>

#include "shoal/thrust_rudder_command_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "shoal/wheel_speeds_command_t.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/drive/drive_support.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

/// Four wheels at (+-0.15, +-0.2) on a plane, each with a quarter of the weight.
std::string skid_world(const std::string& drive) {
  std::string bodies, joints;
  for (const auto& [name, x, y] : std::vector<std::tuple<std::string, std::string, std::string>>{
           {"fl", "0.15", "0.2"}, {"rl", "-0.15", "0.2"}, {"fr", "0.15", "-0.2"}, {"rr", "-0.15", "-0.2"}}) {
    bodies += "        - {name: " + name + "_wheel, position_m: [" + x + ", " + y +
              ", 0.1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 0.5}]}\n";
    joints += "        - {name: " + name + ", type: hinge, bodies: [base, " + name + "_wheel], anchor_m: [" + x + ", " +
              y + ", 0.1], axis: [0, 1, 0]}\n";
  }
  return R"(
shoal: 1
physics: {step_s: 0.001}
contacts: [{between: [any, any], friction: 0.8}]
objects:
  - {name: ground, fixed: true, parts: [{shape: plane}]}
vehicles:
  - name: r1
    model:
      shoal: 1
      vehicle: skid
      bodies:
        - {name: base, parts: [{shape: box, size_m: [0.4, 0.3, 0.1], position_m: [0, 0, 0.12], mass_kg: 10}]}
)" + bodies +
         "      joints:\n" + joints +
         "      devices:\n        - {name: drive, type: skid_steer, left_joints: [fl, rl], right_joints: [fr, rr], "
         "wheel_radius_m: 0.1" +
         drive + "}\n";
}

// Each wheel rubs against its slip, (b w - v, a w) where the sides run at -+v: the moments about the middle balance for
// v / w = b + a^2 / b.  The effective track is twice that: 2 (0.2 + 0.15^2 / 0.2) = 0.625 m.
const std::string track = ", track_m: 0.625, max_speed_mps: 2, max_acceleration_mps2: 5, max_torque_Nm: 20";

using test::twist;

const sim::Vehicle& rover(const test::TestWorld& test) {
  return *test.world.find_vehicle("r1");
}

TEST(SkidSteer, TurnsOnTheSpotWithItsEffectiveTrack) {
  test::TestWorld test(skid_world(track));
  test.send("r1.drive.cmd", twist(0, 1));
  test.run_for(1);
  const double yaw_rad = sim::yaw_of(rover(test).X_WV().linear());
  test.run_for(2);
  const double turned_rad = sim::wrap_angle(sim::yaw_of(rover(test).X_WV().linear()) - yaw_rad);
  EXPECT_NEAR(turned_rad, 2, 0.01);  // 0.5 %: softness of the contacts, as in differential_drive
  EXPECT_LT(rover(test).X_WV().translation().head<2>().norm(), 0.02);
}

TEST(SkidSteer, DrivesStraightAtTheCommandedSpeed) {
  test::TestWorld test(skid_world(track));
  test.send("r1.drive.cmd", twist(0.5, 0));
  test.run_for(1);
  const double x0 = rover(test).X_WV().translation().x();
  test.run_for(4);
  EXPECT_NEAR(rover(test).X_WV().translation().x() - x0, 2.0, 0.002);  // 0.1 %: contact softness (cfm)
  EXPECT_NEAR(rover(test).X_WV().translation().y(), 0.0, 1e-3);        // the solver's order of the wheels
}

TEST(SkidSteer, AllWheelsOfASideTurnAlike) {
  test::TestWorld test(skid_world(track));
  shoal::wheel_speeds_command_t command{};
  command.left_radps = 3;
  command.right_radps = 5;
  test.send("r1.drive.cmd", command);
  test.run_for(1);
  for (const char* name : {"fl", "rl"}) EXPECT_NEAR(rover(test).joint(name).velocity(), 3, 0.02) << name;
  for (const char* name : {"fr", "rr"}) EXPECT_NEAR(rover(test).joint(name).velocity(), 5, 0.02) << name;
}

TEST(SkidSteer, TakesThrustAndRudderAsAVessel) {
  test::TestWorld test(skid_world(track + ", max_turn_radps: 2"));
  shoal::thrust_rudder_command_t command{};
  command.thrust = 0.5;
  command.rudder = 0.2;
  test.send("r1.drive.cmd", command);
  test.run_for(1);
  // 1 m/s and 0.5 * 0.2 * 2 = 0.2 rad/s: sides (1 -+ 0.3125 * 0.2) / 0.1 rad/s.
  EXPECT_NEAR(rover(test).joint("fl").velocity(), 9.375, 0.05);
  EXPECT_NEAR(rover(test).joint("fr").velocity(), 10.625, 0.05);
}

TEST(SkidSteer, DeadItRollsOn) {
  test::TestWorld test(skid_world(track));
  test.send("r1.drive.cmd", twist(0.5, 0));
  test.run_for(1);
  test.world.editor().set_fault("r1/drive", {.kind = sim::FaultKind::dead});
  test.run_for(1);
  EXPECT_EQ(rover(test).joint("fl").motor_max_force(), 0);
  EXPECT_NEAR(rover(test).base().v_WB_W().x(), 0.5, 0.01);  // spheres roll without resistance
}

TEST(SkidSteer, SaysWhatIsWrongWithItsParameters) {
  const auto error_of = [](const std::string& drive) -> std::string {
    try {
      test::TestWorld test(test::rover_world("        - {name: drive, type: skid_steer" + drive + "}\n"));
      return "";
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
  };
  EXPECT_THAT(error_of(""), testing::HasSubstr("device 'drive': missing key 'left_joints'"));
  EXPECT_THAT(error_of(", left_joints: [left], right_joints: []"),
              testing::HasSubstr("'right_joints' must name a joint"));
  EXPECT_THAT(error_of(", left_joints: [left], right_joints: [rght]"),
              testing::HasSubstr("'right_joints' names no joint 'rght'; known joints: left, right"));
  EXPECT_THAT(error_of(", left_joints: [left], right_joints: [right], track_m: 0"),
              testing::HasSubstr("'track_m' must be > 0, got 0"));
}

}  // namespace
