// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/wheel_geometry.hpp"

#include <gmock/gmock.h>

#include "devices/drive/two_sided_drive.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/twist_command_t.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "tests/devices/drive/drive_support.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/sim/medium/log_capture.hpp"

namespace {

using testing::HasSubstr;

/// The rover of the fixture, whose wheels of 0.1 m are 0.5 m apart, without its front caster.
std::string rover(const std::string& keys) {
  std::string yaml =
      test::rover_world("        - {name: drive, type: differential_drive, left_joint: left, right_joint: right" +
                        keys + ", max_acceleration_mps2: 1000, max_torque_Nm: 100}\n");
  const std::size_t caster = yaml.find("            - {name: caster2");
  return yaml.erase(caster, yaml.find('\n', caster) + 1 - caster);
}

using test::warnings_of;

const devices::TwoSidedDrive& drive_of(const test::TestWorld& test) {
  return dynamic_cast<const devices::TwoSidedDrive&>(*test.world.find_device("r1/drive")->actuator());
}

TEST(WheelGeometry, GivesTheTrackAndTheRadiusOfADrive) {
  test::TestWorld test(rover(""));
  EXPECT_DOUBLE_EQ(drive_of(test).track_m(), 0.5);
  EXPECT_DOUBLE_EQ(drive_of(test).wheel_radius_m(), 0.1);
}

/// With the track of 0.4 m that it had before it turned at 0.8 rad/s.
TEST(WheelGeometry, MakesADriveTurnAsFastAsAsked) {
  test::TestWorld test(rover(""));
  shoal::twist_command_t command{};
  command.turn_radps = 1;
  test.send("r1.drive.cmd", command);
  test.run_for(1);
  const double from_rad = sim::yaw_of(test.world.find_vehicle("r1")->X_WV().linear());
  test.run_for(2);
  EXPECT_NEAR(sim::yaw_of(test.world.find_vehicle("r1")->X_WV().linear()) - from_rad, 2, 0.02);  // 1 %: slip
}

TEST(WheelGeometry, IsWhatAGivenTrackIsComparedWith) {
  EXPECT_THAT(
      warnings_of(rover(", track_m: 0.4")),
      HasSubstr("vehicle 'r1': device 'drive': 'track_m' is 0.4, but its joints and wheels make it 0.5: it turns "
                "0.8 times as fast as commanded"));
  EXPECT_EQ(warnings_of(rover(", track_m: 0.49")), "");
  EXPECT_EQ(warnings_of(rover("")), "");
}

TEST(WheelGeometry, SaysWhereTheLengthStands) {
  const std::string yaml = rover(", track_m: 0.4");
  const std::size_t at = yaml.find("track_m: 0.4") + 9;
  const auto line = 1 + std::count(yaml.begin(), yaml.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  const std::size_t column = at - yaml.rfind('\n', at);
  EXPECT_THAT(warnings_of(yaml),
              HasSubstr("worlds/test.yaml:" + std::to_string(line) + ":" + std::to_string(column) + ": "));
}

TEST(WheelGeometry, IsWhatAGivenRadiusIsComparedWith) {
  // It turns the wheels at v / 0.2 m, and they roll 0.1 m a radian.
  EXPECT_THAT(warnings_of(rover(", wheel_radius_m: 0.2")),
              HasSubstr("'wheel_radius_m' is 0.2, but its joints and wheels make it 0.1: it drives 0.5 times as fast"));
}

TEST(WheelGeometry, ChangesWithTheValuesThatAreSet) {
  test::TestWorld test(rover(""));
  ASSERT_EQ(test.change("r1/drive", "{track_m: 0.45}"), "");
  EXPECT_DOUBLE_EQ(drive_of(test).track_m(), 0.45);
  EXPECT_DOUBLE_EQ(drive_of(test).wheel_radius_m(), 0.1);
}

TEST(WheelGeometry, IsWhatOdometryBelievesIn) {
  const std::string odometry =
      "        - {name: odometry, type: odometry, left_joint: left, right_joint: right, ticks_per_revolution: 100000";
  const auto yaml = [&](const std::string& keys) { return test::rover_world(odometry + keys + "}\n"); };
  // Worn tires and an eighth of a track: the first is usual, the second a mistake.
  EXPECT_EQ(warnings_of(yaml("")), "");
  EXPECT_EQ(warnings_of(yaml(", wheel_radius_m: 0.105, track_m: 0.48")), "");
  EXPECT_THAT(warnings_of(yaml(", track_m: 0.4")), HasSubstr("it estimates 1.25 times the turn"));
  EXPECT_THAT(warnings_of(yaml(", wheel_radius_m: 0.2")), HasSubstr("it estimates 2 times the distance"));
}

/// Six bodies at places of one's choice: a car with a wheelbase of 0.4 m, a track of 0.3 m and wheels of 0.06 m.
std::string car(const std::string& keys) {
  std::string bodies, joints;
  for (const auto& [name, x, y] : std::vector<std::tuple<std::string, std::string, std::string>>{
           {"rl", "0", "0.15"}, {"rr", "0", "-0.15"}, {"fl", "0.4", "0.15"}, {"fr", "0.4", "-0.15"}}) {
    bodies += "        - {name: " + name + "_wheel, position_m: [" + x + ", " + y +
              ", 0.06], parts: [{shape: sphere, radius_m: 0.06, mass_kg: 0.3}]}\n";
    const std::string axes =
        name[0] == 'f' ? "hinge2, axis: [0, 0, 1], axis2: {axis: [0, 1, 0]}" : std::string("hinge, axis: [0, 1, 0]");
    joints += "        - {name: " + name + ", type: " + axes + ", bodies: [base, " + name + "_wheel], anchor_m: [" + x +
              ", " + y + ", 0.06]}\n";
  }
  return "shoal: 1\nvehicles:\n  - name: r1\n    model:\n      shoal: 1\n      vehicle: car\n      bodies:\n"
         "        - {name: base, parts: [{shape: box, size_m: [0.5, 0.2, 0.05], position_m: [0.2, 0, 0.08], mass_kg: "
         "4}]}\n" +
         bodies + "      joints:\n" + joints + "      devices:\n        - {name: drive, " + keys + "}\n";
}

const std::string ackermann =
    "type: ackermann_drive, left_steer_joint: fl, right_steer_joint: fr, drive_joints: [rl, rr]";

TEST(WheelGeometry, IsThatOfACar) {
  EXPECT_EQ(warnings_of(car(ackermann)), "");
  EXPECT_EQ(warnings_of(car(ackermann + ", wheelbase_m: 0.4, track_m: 0.3, wheel_radius_m: 0.06")), "");
  EXPECT_THAT(warnings_of(car(ackermann + ", wheelbase_m: 0.3")),
              HasSubstr("'wheelbase_m' is 0.3, but its joints and wheels make it 0.4: it turns 0.75 times as fast"));
  EXPECT_THAT(warnings_of(car(ackermann + ", track_m: 0.2")),
              HasSubstr("the axes of its front wheels do not meet in one center of turn"));
  EXPECT_THAT(warnings_of(car(ackermann + ", wheel_radius_m: 0.05")), HasSubstr("it drives 1.2 times as fast"));
}

/// Steered by 0.5 rad in the middle the inner wheel stands at atan(0.4 t / (0.4 - 0.15 t)) with t = tan 0.5: 0.602 rad.
TEST(WheelGeometry, SaysThatAJointStopsBeforeTheLargestSteering) {
  std::string yaml = car(ackermann + ", max_steering_deg: 28.648");
  const std::string axis = "type: hinge2, axis: [0, 0, 1]";
  for (std::size_t at = yaml.find(axis); at != std::string::npos; at = yaml.find(axis, at + 1))
    yaml.insert(at + axis.size(), ", low_stop: -0.55, high_stop: 0.7");
  EXPECT_THAT(warnings_of(yaml),
              HasSubstr("at 'max_steering_deg' it steers the inner wheel by 0.602 rad, and joint 'fr' "
                        "stops at -0.55"));
  EXPECT_THAT(warnings_of(yaml), testing::Not(HasSubstr("'fl'")));
}

TEST(WheelGeometry, GivesTheTrackOfWheelsThatScrub) {
  const std::string skid = "type: skid_steer, left_joints: [fl, rl], right_joints: [fr, rr]";
  test::TestWorld test(car(skid));
  // 2 (b + a^2 / b) with a = 0.2 m, b = 0.15 m.
  EXPECT_NEAR(drive_of(test).track_m(), 2 * (0.15 + 0.04 / 0.15), 1e-12);
  EXPECT_EQ(warnings_of(car(skid + ", track_m: 0.5")), "") << "as someone measured it";
  EXPECT_THAT(warnings_of(car(skid + ", track_m: 0.2")), HasSubstr("'track_m' is 0.2, but")) << "narrower than it is";
}

TEST(WheelGeometry, TakesTheAnchorOfAWheelThatIsNotRound) {
  std::string yaml = rover("");
  for (const char* side : {"left", "right"}) {
    const std::size_t at =
        yaml.find("{shape: sphere, radius_m: 0.1,", yaml.find(std::string("name: ") + side + "_wheel"));
    yaml.replace(at, 30, "{shape: box, size_m: [0.2, 0.1, 0.2],");
  }
  test::TestWorld test(yaml);
  EXPECT_DOUBLE_EQ(drive_of(test).track_m(), 0.5);
  EXPECT_DOUBLE_EQ(drive_of(test).wheel_radius_m(), 0.1) << "the usual one";
}

using testing::HasSubstr;

/// A rover whose two wheels are in the middle, with one caster before and one behind the axle, so far above the ground.
/// `more`: contacts.
std::string rover(double front_m, double rear_m, const std::string& contacts = "") {
  const auto caster = [](const std::string& name, const std::string& x, double up_m) {
    return "            - {name: " + name + ", shape: sphere, radius_m: 0.05, position_m: [" + x + ", 0, " +
           std::to_string(-0.05 + up_m) + "], mass_kg: 0.1, material: slick}\n";
  };
  return R"(
shoal: 1
physics: {step_s: 0.01}
materials: [{name: slick}]
contacts: [{between: [slick, any], friction: 0})" +
         contacts + R"(]
objects: [{name: ground, fixed: true, parts: [{shape: plane}]}]
vehicles:
  - name: r1
    model:
      shoal: 1
      vehicle: test_rover
      bodies:
        - name: chassis
          position_m: [0, 0, 0.1]
          parts:
            - {name: hull, shape: box, size_m: [0.4, 0.3, 0.1], position_m: [-0.01, 0, 0.03], mass_kg: 17}
)" + caster("front", "0.2", front_m) +
         caster("rear", "-0.2", rear_m) + R"(
        - {name: left_wheel, position_m: [0, 0.2, 0.1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1.5}]}
        - {name: right_wheel, position_m: [0, -0.2, 0.1], parts: [{shape: sphere, radius_m: 0.1, mass_kg: 1.5}]}
      joints:
        - {name: left, type: hinge, bodies: [chassis, left_wheel], anchor_m: [0, 0.2, 0.1], axis: [0, 1, 0]}
        - {name: right, type: hinge, bodies: [chassis, right_wheel], anchor_m: [0, -0.2, 0.1], axis: [0, 1, 0]}
      devices:
        - {name: drive, type: differential_drive, left_joint: left, right_joint: right}
)";
}

using test::warnings_of;

/// Of the turn rate that was asked for, on the spot.
double share_of_turn(const std::string& yaml) {
  const test_support::LogCapture log;
  test::TestWorld test(yaml);
  shoal::twist_command_t command{};
  command.turn_radps = 1;
  test.send("r1.drive.cmd", command);
  test.run_for(1);
  double turned_rad = 0;
  sim::Pose before = test.world.find_vehicle("r1")->X_WV();
  for (int i = 0; i < 40; ++i) {
    test.run_for(0.1);
    const sim::Pose now = test.world.find_vehicle("r1")->X_WV();
    turned_rad += sim::yaw_of((before.inverse() * now).linear());
    before = now;
  }
  return turned_rad / 4;
}

TEST(WeightOnWheels, IsUndeterminedWithCastersBeforeAndBehind) {
  EXPECT_THAT(warnings_of(rover(0, 0)),
              HasSubstr("vehicle 'r1': device 'drive': how much weight its driven wheels carry is undetermined: "
                        "'chassis/front', 'chassis/rear' stand as low as they (4 points of one rigid vehicle)"));
}

TEST(WeightOnWheels, IsDeterminedWithOneCasterRaised) {
  EXPECT_EQ(warnings_of(rover(0.001, 0)), "");
  EXPECT_EQ(warnings_of(rover(0.0005, 0.0005)), "");
}

/// A caster that is lower tips the rover on to it and one wheel, or on to both and no wheel.
TEST(WeightOnWheels, IsUndeterminedWithCastersBelowTheWheels) {
  EXPECT_THAT(warnings_of(rover(-0.001, -0.001)), HasSubstr("is undetermined"));
}

/// Casters with friction carry what they like, and hold the rover back; raised by 0.1 mm they do not touch.
TEST(WeightOnWheels, DecidesHowFastItTurns) {
  const std::string friction = ", {between: [slick, any], friction: 0.8}";
  EXPECT_LT(share_of_turn(rover(0, 0, friction)), 0.5);
  EXPECT_NEAR(share_of_turn(rover(0.0001, 0.0001, friction)), 1, 0.01);
  EXPECT_NEAR(share_of_turn(rover(0.001, 0, friction)), 1, 0.01);
}

TEST(WeightOnWheels, IsNotLookedAtWithASuspensionOrSoftContacts) {
  EXPECT_EQ(warnings_of(rover(0, 0, ", {between: [any, any], soft_cfm: 0.001}")), "");
  std::string yaml = rover(0, 0);
  const std::string hinge = "type: hinge, bodies: [chassis, left_wheel], anchor_m: [0, 0.2, 0.1], axis: [0, 1, 0]";
  yaml.replace(yaml.find(hinge), hinge.size(),
               "type: hinge2, bodies: [chassis, left_wheel], anchor_m: [0, 0.2, 0.1], axis: [0, 0, 1], low_stop: 0, "
               "high_stop: 0, suspension_erp: 0.4, suspension_cfm: 0.001, axis2: {axis: [0, 1, 0]}");
  EXPECT_EQ(warnings_of(yaml), "");
}

/// The weight on the driven rear axle follows from the middle of mass, and so it does with casters on one side of it.
TEST(WeightOnWheels, IsDeterminedWithTheOthersOnOneLineBesideTheAxle) {
  std::string yaml = rover(0.01, 0.01);
  const std::size_t wheel = yaml.find("        - {name: left_wheel");
  yaml.insert(wheel,
              "            - {name: left_foot, shape: sphere, radius_m: 0.05, position_m: [0.2, 0.1, -0.05]}\n"
              "            - {name: right_foot, shape: sphere, radius_m: 0.05, position_m: [0.2, -0.1, -0.05]}\n");
  EXPECT_EQ(warnings_of(yaml), "");
}

}  // namespace
