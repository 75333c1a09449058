// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/wheel_sides.hpp"

#include <gmock/gmock.h>

#include <string>
#include <tuple>
#include <vector>

#include "tests/devices/drive/drive_support.hpp"

namespace {

using testing::HasSubstr;

/// A wheel of a vehicle and its joint to the base.
struct SideWheel {
  std::string name, x_m, y_m;
  std::string joint = "type: hinge, axis: [0, 1, 0]";
  bool wheel_first = false;
  std::string shape = "shape: sphere, radius_m: 0.1";
};

const SideWheel left_wheel{"left", "0", "0.2"}, right_wheel{"right", "0", "-0.2"};
const std::string steered = "type: hinge2, axis: [0, 0, 1], axis2: {axis: [0, 1, 0]}";
const std::vector<SideWheel> of_car = {
    {"rl", "0", "0.15"}, {"rr", "0", "-0.15"}, {"fl", "0.4", "0.15", steered}, {"fr", "0.4", "-0.15", steered}};

/// What is warned of when a vehicle with such wheels and devices is built.
std::string warnings_of_sides(const std::vector<SideWheel>& wheels, const std::vector<std::string>& devices,
                              const std::string& entry = "") {
  std::string bodies, joints, list;
  for (const SideWheel& wheel : wheels) {
    bodies += "        - {name: " + wheel.name + "_wheel, position_m: [" + wheel.x_m + ", " + wheel.y_m +
              ", 0.1], parts: [{" + wheel.shape + ", mass_kg: 0.3}]}\n";
    const std::string own = wheel.name + "_wheel";
    joints += "        - {name: " + wheel.name + ", " + wheel.joint + ", bodies: [" +
              (wheel.wheel_first ? own + ", base" : "base, " + own) + "], anchor_m: [" + wheel.x_m + ", " + wheel.y_m +
              ", 0.1]}\n";
  }
  for (const std::string& device : devices)
    list += "        - {name: d" + std::to_string(list.size()) + ", " + device + "}\n";
  return test::warnings_of("shoal: 1\nvehicles:\n  - name: r1\n" + entry +
                           "    model:\n      shoal: 1\n      vehicle: v\n      bodies:\n"
                           "        - {name: base, parts: [{shape: box, size_m: [0.5, 0.2, 0.05], position_m: "
                           "[0.1, 0, 0.2], mass_kg: 4}]}\n" +
                           bodies + "      joints:\n" + joints + "      devices:\n" + list);
}

const std::string two_wheel_drive = "type: differential_drive, left_joint: left, right_joint: right";
const std::string wheel_odometry = "type: odometry, left_joint: left, right_joint: right";
const std::string car_drive =
    "type: ackermann_drive, left_steer_joint: fl, right_steer_joint: fr, drive_joints: [rl, rr]";
const std::string skid_drive = "type: skid_steer, left_joints: [fl, rl], right_joints: [fr, rr]";

SideWheel changed(SideWheel wheel, const std::string& joint) {
  wheel.joint = joint;
  return wheel;
}

TEST(WheelSides, NothingIsWarnedOfInCorrectFiles) {
  EXPECT_EQ(warnings_of_sides({left_wheel, right_wheel}, {two_wheel_drive, wheel_odometry}), "");
  EXPECT_EQ(warnings_of_sides({left_wheel, right_wheel}, {two_wheel_drive}, "    rpy_deg: [0, 0, 135]\n"), "");
  EXPECT_EQ(warnings_of_sides(of_car, {car_drive}), "");
  EXPECT_EQ(warnings_of_sides(of_car, {skid_drive}), "");
  // A camber of 20 degrees and toe-in of 10.
  EXPECT_EQ(warnings_of_sides({changed(left_wheel, "type: hinge, axis: [-0.17, 0.93, 0.34]"),
                               changed(right_wheel, "type: hinge, axis: [0.17, 0.93, -0.34]")},
                              {two_wheel_drive}),
            "");
  // The wheel is the first body, so that its joint counts how the base turns on it.
  SideWheel turned_round = changed(left_wheel, "type: hinge, axis: [0, -1, 0]");
  turned_round.wheel_first = true;
  EXPECT_EQ(warnings_of_sides({turned_round, right_wheel}, {two_wheel_drive}), "");
}

TEST(WheelSides, NothingIsWarnedOfOnATrikeOrWithMecanumWheels) {
  // Driven by one wheel in the middle, which is steered, between two that are not.
  const std::vector<SideWheel> trike = {{"rl", "0", "0.15"}, {"rr", "0", "-0.15"}, {"front", "0.4", "0", steered}};
  EXPECT_EQ(warnings_of_sides(trike, {"type: ackermann_drive, left_steer_joint: front, right_steer_joint: front, "
                                      "drive_joints: [front], track_m: 0.01"}),
            "");
  // One motor for each wheel.
  EXPECT_EQ(warnings_of_sides(of_car, {"type: joint_motor, joint: rl", "type: joint_motor, joint: rr"}), "");
}

TEST(WheelSides, AnAxisThatTurnsItsWheelBackwardsIsWarnedOfOnce) {
  const std::string text = warnings_of_sides({left_wheel, changed(right_wheel, "type: hinge, axis: [0, -1, 0]")},
                                             {two_wheel_drive, wheel_odometry});
  EXPECT_THAT(text, HasSubstr("vehicle 'r1': joint 'right': its wheel turns backwards at positive speed (axis [0, -1, "
                              "0] of 'right_wheel' on 'base'): a drive needs a wheel that turns positively about +y on "
                              "its carrier"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
  EXPECT_THAT(text, HasSubstr("worlds/test.yaml:13:11: ")) << "where the joint is";
}

TEST(WheelSides, BothAxesReversedAreWarnedOf) {
  const std::string reversed = "type: hinge, axis: [0, -1, 0]";
  const std::string text =
      warnings_of_sides({changed(left_wheel, reversed), changed(right_wheel, reversed)}, {two_wheel_drive});
  for (const char* joint : {"joint 'left': its wheel turns backwards", "joint 'right': its wheel turns backwards"})
    EXPECT_THAT(text, HasSubstr(joint));
}

TEST(WheelSides, AWheelThatIsTheFirstBodyCountsTheOtherWay) {
  SideWheel first = right_wheel;
  first.wheel_first = true;
  EXPECT_THAT(warnings_of_sides({left_wheel, first}, {two_wheel_drive}),
              HasSubstr("joint 'right': its wheel turns backwards at positive speed (axis [0, 1, 0] of 'base' on "
                        "'right_wheel')"));
}

TEST(WheelSides, AWheelThatIsNotRoundIsTheBodyThatIsNotTheFirst) {
  SideWheel square = changed(right_wheel, "type: hinge, axis: [0, -1, 0]");
  square.shape = "shape: box, size_m: [0.2, 0.1, 0.2]";
  EXPECT_THAT(warnings_of_sides({left_wheel, square}, {two_wheel_drive}),
              HasSubstr("joint 'right': its wheel turns backwards"));
}

TEST(WheelSides, SwappedJointsAreWarnedOf) {
  EXPECT_THAT(
      warnings_of_sides({left_wheel, right_wheel}, {"type: differential_drive, left_joint: right, right_joint: left"}),
      HasSubstr("device 'd0': 'left_joint' names 'right' at y = -0.2 m, on the right, 'right_joint' names "
                "'left' at y = 0.2 m, on the left: left is +y"));
  EXPECT_THAT(warnings_of_sides({left_wheel, right_wheel},
                                {two_wheel_drive, "type: odometry, left_joint: right, right_joint: left"}),
              HasSubstr("'left_joint' names 'right' at y = -0.2 m"));
  EXPECT_THAT(
      warnings_of_sides(of_car, {"type: skid_steer, left_joints: [rr, fr], right_joints: [fl, rl], track_m: 1"}),
      HasSubstr("'left_joints' names 'rr' at y = -0.15 m, on the right, 'left_joints' names 'fr'"));
}

TEST(WheelSides, WrongAxesAndSidesOfACarAreWarnedOf) {
  std::vector<SideWheel> wheels = of_car;
  wheels[2].joint = "type: hinge2, axis: [0, 0, -1], axis2: {axis: [0, 1, 0]}";
  EXPECT_THAT(warnings_of_sides(wheels, {car_drive}),
              HasSubstr("joint 'fl': it steers to the right at positive angles (axis [0, 0, -1] of 'fl_wheel' on "
                        "'base'): a drive needs one that turns positively about +z, to the left"));
  wheels = of_car;
  wheels[0].joint = wheels[1].joint = "type: hinge, axis: [0, -1, 0]";
  EXPECT_THAT(warnings_of_sides(wheels, {car_drive}), HasSubstr("joint 'rr': its wheel turns backwards"));
  EXPECT_THAT(
      warnings_of_sides(of_car, {"type: ackermann_drive, left_steer_joint: fr, right_steer_joint: fl, drive_joints: "
                                 "[rl, rr]"}),
      HasSubstr("'left_steer_joint' names 'fr' at y = -0.15 m, on the right"));
}

}  // namespace
