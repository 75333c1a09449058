// SPDX-License-Identifier: BSD-3-Clause
// What joints devices take.

#include <gmock/gmock.h>

#include "tests/devices/world_fixture.hpp"

namespace {

/// The rover with another joint at its left wheel.
std::string error_of(const std::string& left_joint, const std::string& device) {
  std::string yaml = test::rover_world("        - {name: d, type: " + device + "}\n");
  const std::string hinge = "type: hinge, bodies: [chassis, left_wheel], anchor_m: [0, 0.25, 0.1], axis: [0, 1, 0]";
  yaml.replace(yaml.find(hinge), hinge.size(), "bodies: [chassis, left_wheel], " + left_joint);
  return test::error_of_world(yaml);
}

const std::string fixed = "type: fixed";
const std::string ball = "type: ball, anchor_m: [0, 0.25, 0.1]";
const std::string slider = "type: slider, axis: [0, 1, 0]";
const std::string hinge2 = "type: hinge2, anchor_m: [0, 0.25, 0.1], axis: [0, 0, 1], axis2: {axis: [0, 1, 0]}";

TEST(JointOfDevice, AMotorNeedsAnAxis) {
  const std::string motor = "joint_motor, joint: left";
  EXPECT_THAT(error_of(fixed, motor), testing::HasSubstr("device 'd': joint 'left' is fixed and has no axis"));
  EXPECT_THAT(error_of(ball, motor), testing::HasSubstr("device 'd': joint 'left' is a ball joint and has no axis"));
  EXPECT_EQ(error_of(slider, motor), "");
}

TEST(JointOfDevice, WheelsAreOnHinges) {
  for (const std::string device :
       {"odometry, left_joint: left, right_joint: right", "differential_drive, left_joint: left, right_joint: right",
        "skid_steer, left_joints: [left], right_joints: [right]",
        "ackermann_drive, left_steer_joint: left, right_steer_joint: right, "
        "drive_joints: [right]",
        "ackermann_drive, left_steer_joint: right, right_steer_joint: right, "
        "drive_joints: [left]"}) {
    const std::string what = "; a wheel must be on a hinge or hinge2";
    EXPECT_THAT(error_of(fixed, device), testing::HasSubstr("device 'd': joint 'left' is fixed" + what)) << device;
    EXPECT_THAT(error_of(ball, device), testing::HasSubstr("joint 'left' is a ball joint" + what)) << device;
    EXPECT_THAT(error_of(slider, device), testing::HasSubstr("joint 'left' is a slider" + what)) << device;
    EXPECT_EQ(error_of(hinge2, device), "") << device;
  }
}

}  // namespace
