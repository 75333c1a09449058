// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>

#include "shoal/sim_scene_t.hpp"
#include "tests/bridges/ros2/converted.hpp"
#include "tests/bridges/ros2/known_devices.hpp"

namespace {

using namespace known_devices;

using bridges::ros2::ConverterContext;
using test::converted;

TEST(RosConventions, EveryDeviceHasAFrameInItsVehicleOrInAMovingBody) {
  ConverterContext context = knowing(
      R"({"name": "lidar", "body": 3, "pose": [0.5, 0, 0, 0, 0, 0, 1], "channels": ["auv1.lidar"]},
         {"name": "gripper", "body": 4, "pose": [1, 0, 0, 1, 0, 0, 0], "channels": []},
         {"name": "gps", "body": 3, "pose": [0, 0, 0, 1, 0, 0, 0], "channels": ["fixes"]},
         {"name": "camera", "body": 3, "pose": [0, 0, 0, 1, 0, 0, 0], "channels": ["auv1.camera"],
          "field_of_view": {"kind": "frustum", "range_m": 100}},
         {"name": "altimeter", "body": 3, "pose": [0, 0, 0, 1, 0, 0, 0], "channels": ["auv1.altimeter"],
          "field_of_view": {"kind": "cone", "axis": [0, 0, -1], "half_angle_rad": 0.1, "range_m": 50}},
         {"name": "odom", "body": 3, "channels": ["auv1.odom"], "origin": [0, 0, 0, 1, 0, 0, 0]},
         {"name": "lost", "body": 9, "channels": []}, 7)");
  const auto frames = frames_of(converted(shoal::sim_scene_t{}, "/tf_static", "sim.scene", &context));
  EXPECT_EQ(frames.size(), 8u);  // odometry is of the vehicle, and nothing is known of the body of `lost`
  // The vehicle frame is 1 m below that of its first body.
  EXPECT_THAT(frames.at("auv1 > auv1/lidar"), near_to({0.5, 0, 1, 0, 0, 1, 0}));
  EXPECT_THAT(frames.at("auv1/body/arm > auv1/gripper"), near_to({1, 0, 0, 0, 0, 0, 1}));
  EXPECT_THAT(frames.at("auv1 > fixes"), near_to({0, 0, 1, 0, 0, 0, 1}));
  // REP 103: z ahead, x to the right, y down.
  EXPECT_THAT(frames.at("auv1/camera > auv1/camera_optical"), near_to({0, 0, 0, -0.5, 0.5, -0.5, 0.5}));
  // A quarter turn about y takes x to -z.
  EXPECT_THAT(frames.at("auv1/altimeter > auv1/altimeter_beam"),
              near_to({0, 0, 0, 0, std::sqrt(0.5), 0, std::sqrt(0.5)}));
  EXPECT_FALSE(converted(shoal::sim_scene_t{}, "/tf_static", "sim.scene"));
}

}  // namespace
