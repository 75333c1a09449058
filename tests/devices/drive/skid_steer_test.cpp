// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/skid_steer.hpp"

#include <gmock/gmock.h>

#include "shoal/thrust_rudder_command_t.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/drive/drive_support.hpp"
#include "tests/devices/drive/skid_steer_fixture.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace skid_steer_fixture;

using test::twist;

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
