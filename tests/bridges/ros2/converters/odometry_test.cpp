// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "shoal/estimate_t.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/pose_t.hpp"
#include "shoal/sim_info_t.hpp"
#include "shoal/sim_scene_t.hpp"
#include "tests/bridges/ros2/converted.hpp"
#include "tests/bridges/ros2/known_devices.hpp"

namespace {

using namespace known_devices;
using bridges::ros2::ConverterContext;

using namespace bridges::ros2;

using test::converted;
using test::expect_header;

TEST(Ros2Converter, VelocitiesOfOdometryAreInTheAxesOfTheVehicle) {
  // Heading north (yaw 90 degrees) with 2 m/s to the north: forward.
  const double half = std::sqrt(0.5);
  shoal::pose_t pose{1'500'000, {0, 0, 0}, {0, 2, 0}, {half, 0, 0, half}, {0, 0, 1}, {0, 0, 0}};
  auto in = converted(pose, "odometry", "auv1.estimate");
  expect_header(*in, "world");
  EXPECT_EQ(in->text(), "auv1");
  in->skip<double>(7 + 36);
  for (const double value : {2.0, 0.0, 0.0, 0.0, 0.0, 1.0}) EXPECT_NEAR(in->number<double>(), value, 1e-12);
  in->skip<double>(36);
  EXPECT_TRUE(in->at_end());
}

TEST(RosConventions, WheelOdometryIsThePoseOfTheVehicleInAFrameWhereItStarted) {
  ConverterContext context;
  const shoal::odometry_t odometry{1'500'000, 3, 4, M_PI, 0.5, 0.25, 0, 0};
  auto in = converted(odometry, "odometry", "a.odometry", &context);
  expect_header(*in, "a/odom");
  EXPECT_EQ(in->text(), "a");
  for (const double value : {3.0, 4.0, 0.0, 0.0, 0.0, 1.0}) EXPECT_EQ(in->number<double>(), value);
  in->skip<double>(1 + 36);
  for (const double value : {0.5, 0.0, 0.0, 0.0, 0.0, 0.25}) EXPECT_EQ(in->number<double>(), value);
  // The scene tells where that is, also for vehicles by `count` and those that came later.
  context = knowing(
      R"({"name": "odometry", "type": "odometry", "body": 3, "channels": ["auv1.odometry"],
          "origin": [1, 2, 0, 0, 0, 0, 1]})");
  const auto frames = frames_of(converted(shoal::sim_scene_t{}, "/tf_static", "sim.scene", &context));
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_THAT(frames.at("world > auv1/odom"), near_to({1, 2, 0, 0, 0, 1, 0}));
  // They come again with each sim.info.
  EXPECT_EQ(frames_of(converted(shoal::sim_info_t{}, "/tf_static", "sim.info", &context)), frames);
}

TEST(RosConventions, AnEstimateOfAClientIsThePoseOfItsVehicle) {
  // Also where the channel tells no vehicle: the channel itself.
  shoal::pose_t pose{};
  pose.utime = 1'500'000;
  pose.orientation[0] = 1;
  for (const auto& [channel, frame] : {std::pair{"rover1.estimate", "rover1"}, {"guess", "guess"}}) {
    auto in = converted(pose, "odometry", channel);
    expect_header(*in, "world");
    EXPECT_EQ(in->text(), frame);
  }
}

TEST(RosConventions, OnlyADeviceOrAnEstimateTellsThePoseOfAVehicle) {
  ConverterContext context = knowing(device_with("{}"));
  shoal::pose_t pose{};
  pose.utime = 1'500'000;
  pose.orientation[0] = 1;
  for (const auto& [channel, frame] : {std::pair{"rover1.goal", "rover1/goal"}, {"auv1.x", "auv1"}}) {
    auto in = converted(pose, "odometry", channel, &context);
    expect_header(*in, "world");
    EXPECT_EQ(in->text(), frame);
  }
}

TEST(RosConventions, AnOrientationHasTheLengthOneOrIsNone) {
  // Heading north at 1 m/s, with a quaternion of the length 2 sqrt(2).
  shoal::pose_t pose{1'500'000, {0, 0, 0}, {0, 1, 0}, {2, 0, 0, 2}, {0, 0, 0}, {0, 0, 0}};
  auto in = converted(pose, "odometry", "auv1.estimate");
  expect_header(*in, "world");
  in->text();
  in->skip<double>(3);
  const double half = std::sqrt(0.5);
  for (const double value : {0.0, 0.0, half, half}) EXPECT_NEAR(in->number<double>(), value, 1e-12);
  in->skip<double>(36);
  for (const double value : {1.0, 0.0, 0.0}) EXPECT_NEAR(in->number<double>(), value, 1e-12);
  for (const double none : {0.0, std::numeric_limits<double>::quiet_NaN()}) {
    for (double& each : pose.orientation) each = none;
    EXPECT_FALSE(converted(pose, "odometry", "auv1.estimate")) << none;
  }
}

using namespace bridges::ros2;

using test::converted;
using test::expect_header;

TEST(Ros2Converter, AnEstimateIsAPoseInTheWorldWithItsCovariance) {
  shoal::estimate_t estimate{1'500'000, {1, 2, 3}, {1, 2, 3, 4, 5, 6, 7, 8, 9}, {0, 0, 0}, M_PI, 0};
  auto in = converted(estimate, "pose");
  expect_header(*in, "world");
  for (const double value : {1.0, 2.0, 3.0, 0.0, 0.0, 1.0}) EXPECT_EQ(in->number<double>(), value);
  EXPECT_NEAR(in->number<double>(), 0.0, 1e-15);  // cos(pi/2)
  const double rows[3][6] = {{1, 2, 3, 0, 0, 0}, {4, 5, 6, 0, 0, 0}, {7, 8, 9, 0, 0, 0}};
  for (const auto& row : rows)
    for (const double value : row) EXPECT_EQ(in->number<double>(), value);
  in->skip<double>(18);
  EXPECT_TRUE(in->at_end());
}

}  // namespace
