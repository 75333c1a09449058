// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/estop_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

std::string rover(const std::string& estop, const std::string& objects = "") {
  return test::rover_world(
      "        - {name: drive, type: differential_drive, left_joint: left, right_joint: right, wheel_radius_m: 0.1,\n"
      "           track_m: 0.5, max_acceleration_mps2: 5, max_torque_Nm: 20}\n"
      "        - {name: bumper, type: bumper, parts: [chassis/hull]}\n"
      "        - {name: estop, type: estop, rate_hz: every_step" +
          estop + "}\n",
      objects);
}

void drive(test::TestWorld& test) {
  shoal::twist_command_t command{};
  command.forward_mps = 0.5;
  test.send("r1.drive.cmd", command);
}

void set_engaged(test::TestWorld& test, bool engaged) {
  shoal::estop_t command{};
  command.engaged = engaged;
  test.send("r1.estop.cmd", command);
}

double speed(const test::TestWorld& test) {
  return test.world.find_vehicle("r1")->base().v_WB_W().x();
}

TEST(EmergencyStop, BrakesAndHoldsUntilANewCommandAfterTheRelease) {
  test::TestWorld test(rover(""));
  test::Listener<shoal::estop_t> reports(test, "r1.estop");
  drive(test);
  test.run_for(1);
  ASSERT_NEAR(speed(test), 0.5, 0.01);
  EXPECT_EQ(reports.last().engaged, 0);
  set_engaged(test, true);
  test.run_for(0.5);  // 0.1 s to brake at 5 m/s^2
  EXPECT_NEAR(speed(test), 0, 1e-3);
  EXPECT_EQ(reports.last().engaged, 1);
  drive(test);
  test.run_for(0.5);
  EXPECT_NEAR(speed(test), 0, 1e-3);
  set_engaged(test, false);
  test.run_for(0.5);
  EXPECT_EQ(reports.last().engaged, 0);
  EXPECT_NEAR(speed(test), 0, 1e-3);
  drive(test);
  test.run_for(1);
  EXPECT_NEAR(speed(test), 0.5, 0.01);
}

TEST(EmergencyStop, CanBeEngagedFromTheStart) {
  test::TestWorld test(rover(", engaged_at_start: true"));
  drive(test);
  test.run_for(0.5);
  EXPECT_NEAR(speed(test), 0, 1e-6);
}

TEST(EmergencyStop, StopsWhenTheBumperTouchesAndLetsGoWhenReleased) {
  test::TestWorld test(rover(", stops_on_touch: bumper",
                             "  - {name: wall, fixed: true, position_m: [1.3, 0, 0.5], parts: [{shape: box, "
                             "size_m: [0.2, 2, 1]}]}\n"));
  test::Listener<shoal::estop_t> reports(test, "r1.estop");
  drive(test);
  test.run_for(4);
  EXPECT_EQ(reports.last().engaged, 1);
  EXPECT_NEAR(test.world.find_vehicle("r1")->X_WV().translation().x(), 1.0, 0.01);  // the hull ends 0.2 m in front
  EXPECT_NEAR(speed(test), 0, 1e-3);
  set_engaged(test, false);
  test.run_for(0.1);
  shoal::twist_command_t back{};
  back.forward_mps = -0.5;
  test.send("r1.drive.cmd", back);
  test.run_for(1);
  EXPECT_EQ(reports.last().engaged, 0);
  EXPECT_LT(test.world.find_vehicle("r1")->X_WV().translation().x(), 0.7);
}

TEST(EmergencyStop, WorksWithoutPower) {
  test::TestWorld test(rover(""));
  test::Listener<shoal::estop_t> reports(test, "r1.estop");
  test.world.vehicles().front()->systems().powered = false;
  set_engaged(test, true);
  test.run_for(0.1);
  EXPECT_EQ(reports.last().engaged, 1);
}

TEST(EmergencyStop, NamesABumperThatDoesNotExist) {
  try {
    test::TestWorld test(rover(", stops_on_touch: drive"));
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("device 'estop': 'stops_on_touch' names no bumper 'drive'"));
  }
}

}  // namespace
