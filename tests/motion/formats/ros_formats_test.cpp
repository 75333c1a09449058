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

TEST(PlayMotion2Format, StartsAtTheLeastTimeOfTheApproach) {
  sim::JointMotion motion = test::motion({{0, {{"a", 0}, {"b", 1}}}, {0.8, {{"a", -0.5}}}});
  motion.description = "lifts: the paw";
  motion.start.min_s = 0.5;
  const test::Written file = test::written("play_motion2", motion);
  EXPECT_EQ(file.bytes,
            "play_motion2:\n  ros__parameters:\n    motions:\n      wave:\n        joints: [a, b]\n"
            "        positions: [0.0, 1.0, -0.5, 1.0]\n        times_from_start: [0.5, 1.3]\n"
            "        meta: {name: wave, usage: shoal, description: \"lifts: the paw\"}\n");
  EXPECT_THAT(file.losses, IsEmpty());
  const test::Read again = test::read("play_motion2", file.bytes);
  EXPECT_EQ(again.motion.name, "wave");
  EXPECT_EQ(again.motion.description, "lifts: the paw");
  EXPECT_DOUBLE_EQ(again.motion.start.min_s, 0.5);
  EXPECT_DOUBLE_EQ(again.motion.end_s(), 0.8);
  EXPECT_THAT(again.losses, IsEmpty());
}

TEST(PlayMotion2Format, ChoosesOneOfSeveralMotions) {
  const std::string text =
      "node:\n  ros__parameters:\n    motions:\n      home: {joints: [a], positions: [1.0], times_from_start: [0.5]}\n"
      "      wave: {joints: [a], positions: [2.0, 3.0], times_from_start: [0.5, 1.0]}\n";
  EXPECT_EQ(test::read_error("play_motion2", text), "file:4:7: has several motions: choose one (--name) of home, wave");
  motion::FormatOptions options;
  options.name = "wave";
  EXPECT_DOUBLE_EQ(test::value(test::read("play_motion2", text, {}, options).motion, "a", 0), 2);
  options.name = "wav";
  EXPECT_EQ(test::error_of([&] { test::read("play_motion2", text, {}, options); }),
            "file:4:7: there is no motion 'wav'; did you mean 'wave'?; known: home, wave");
}

TEST(PlayMotion2Format, SaysWhereAndWhatIsWrong) {
  const auto error = [](const std::string& motion) {
    return test::read_error("play_motion2", "motions:\n  wave: " + motion + "\n");
  };
  EXPECT_EQ(test::read_error("play_motion2", "a: {b: 1}\n"),
            "file:1:1: needs the map 'motions', below 'NODE: ros__parameters:'");
  EXPECT_EQ(error("3"), "file:2:3: motion 'wave' must be a map");
  EXPECT_THAT(error("{joints: [a], positions: [1, 2, 3], times_from_start: [0, 1]}"),
              HasSubstr("file:2:9: 'positions' must have 1 x 2 values, for each joint and time, got 3"));
  EXPECT_THAT(error("{joints: [a], positions: [1, 2], times_from_start: [1, 1]}"),
              HasSubstr("'times_from_start' must increase: 1 comes after 1"));
  EXPECT_THAT(error("{joints: [a], position: [1], times_from_start: [1]}"),
              HasSubstr("motion 'wave': unknown key 'position'"));
}

}  // namespace
