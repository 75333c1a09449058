// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>

#include "tests/motion/formats/format_fixture.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(RosFormat, WritesPositionsOnlySoThatControllersGoInStraightLines) {
  const test::Written file = test::written("ros", test::motion({{0, {{"a b", 0}, {"c", -1}}}, {1.5, {{"a b", 0.25}}}}));
  EXPECT_EQ(file.bytes,
            "# trajectory_msgs/msg/JointTrajectory\n"
            "header: {stamp: {sec: 0, nanosec: 0}, frame_id: ''}\n"
            "joint_names: [\"a b\", c]\n"
            "points:\n"
            "- {positions: [0.0, -1.0], time_from_start: {sec: 0, nanosec: 0}}\n"
            "- {positions: [0.25, -1.0], time_from_start: {sec: 1, nanosec: 500000000}}\n");
  EXPECT_THAT(file.losses, IsEmpty());
}

TEST(RosFormat, SamplesTheCubicOfPointsWithVelocities) {
  // A message as `ros2 topic echo` prints it.  From rest at 0 to rest at 1 in 0.4 s: 3 s^2 - 2 s^3.
  const test::Read file =
      test::read("ros",
                 "header:\n  stamp:\n    sec: 0\n    nanosec: 0\n  frame_id: ''\njoint_names:\n- knee\npoints:\n"
                 "- positions: [0.0]\n  velocities: [0.0]\n  accelerations: []\n  effort: []\n"
                 "  time_from_start: {sec: 0, nanosec: 0}\n"
                 "- positions: [1.0]\n  velocities: [0.0]\n  accelerations: []\n  effort: [2.0]\n"
                 "  time_from_start: {sec: 0, nanosec: 400000000}\n---\n");
  EXPECT_NEAR(test::value(file.motion, "knee", 0.2), 0.5, 1e-12);
  EXPECT_NEAR(test::value(file.motion, "knee", 0.08), 3 * 0.04 - 2 * 0.008, 1e-12);
  EXPECT_THAT(file.losses, ElementsAre("the path by 'velocities' is sampled every 8 ms", "'effort' is not kept"));
}

TEST(RosFormat, SamplesTheQuinticOfPointsWithVelocitiesAndAccelerations) {
  // x(t) = t^5 - 2 t^4 + t^3 + 3 t^2 - t + 2 from 0 to 2 s: a quintic is its own path.
  const test::Read file =
      test::read("ros",
                 "joint_names: [knee]\npoints:\n"
                 "- {positions: [2], velocities: [-1], accelerations: [6], time_from_start: {sec: 0}}\n"
                 "- {positions: [20], velocities: [39], accelerations: [82], time_from_start: {sec: 2}}\n");
  for (const double t : {0.2, 0.8, 1.0, 1.6})
    EXPECT_NEAR(test::value(file.motion, "knee", t),
                std::pow(t, 5) - 2 * std::pow(t, 4) + std::pow(t, 3) + 3 * t * t - t + 2, 1e-12)
        << t;
  EXPECT_THAT(file.losses, ElementsAre("the path by 'velocities' is sampled every 8 ms"));
}

TEST(RosFormat, SaysThatAccelerationsOfOnePointAreNotUsed) {
  const test::Read file =
      test::read("ros",
                 "joint_names: [knee]\npoints:\n- {positions: [0], velocities: [0], time_from_start: {sec: 0}}\n"
                 "- {positions: [1], velocities: [0], accelerations: [5], time_from_start: {sec: 1}}\n");
  EXPECT_NEAR(test::value(file.motion, "knee", 0.2), 3 * 0.04 - 2 * 0.008, 1e-12);
  EXPECT_THAT(file.losses,
              ElementsAre("the path by 'velocities' is sampled every 8 ms",
                          "'accelerations' count only between two points that have them and 'velocities'"));
}

TEST(RosFormat, ReadsTheGoalOfAnActionOfRos1) {
  const test::Read file = test::read(
      "ros", "trajectory: {joint_names: [a], points: [{positions: [2], time_from_start: {secs: 3, nsecs: 5}}]}\n");
  EXPECT_DOUBLE_EQ(file.motion.end_s(), 3.000000005);
}

TEST(RosFormat, SaysWhereAndWhatIsWrong) {
  const auto error = [](const std::string& text) { return test::read_error("ros", text); };
  EXPECT_EQ(error("[]\n"), "file:1:1: the file must be a map");
  EXPECT_THAT(error("joint_names: [a]\n"), HasSubstr("file:1:1: missing key 'points'"));
  EXPECT_THAT(error("joint_names: [a]\npoints:\n- {positions: [1, 2], time_from_start: {sec: 0}}\n"),
              HasSubstr("file:3:3: 'positions' must have a value for each of 1 joints, got 2"));
  EXPECT_THAT(error("joint_names: [a]\npoints:\n- {positions: [1], time_from_start: {sec: 1}}\n- {positions: [1], "
                    "time_from_start: {sec: 1}}\n"),
              HasSubstr("file:4:3: 'time_from_start' must be above that of the point before, 1, got 1"));
  EXPECT_THAT(
      error("joint_names: [a]\npoints:\n- {positions: [1], accelerations: [1, 2], time_from_start: {sec: 0}}\n"),
      HasSubstr("file:3:3: 'accelerations' must have a value for each of 1 joints, got 2"));
  EXPECT_THAT(error("joint_names: [a]\npoints:\n- {positions: [.nan], time_from_start: {sec: 1}}\n"),
              HasSubstr("file:3:"));
  EXPECT_EQ(error("joint_names: [a, a]\npoints: [{positions: [1, 1], time_from_start: {sec: 1}}]\n"),
            "file:1:1: must name each joint once, got 'a'");
}

TEST(RosFormat, RefusesAPathThatLeavesTheRange) {
  EXPECT_EQ(
      test::read_error("ros",
                       "joint_names: [a]\npoints:\n- {positions: [0], velocities: [1e9], time_from_start: {sec: 0}}\n"
                       "- {positions: [0], velocities: [0], time_from_start: {sec: 1}}\n"),
      "file:4:3: the path by 'velocities' must stay within -1e6 and 1e6");
}

}  // namespace
