// SPDX-License-Identifier: BSD-3-Clause
#include "motion/analysis/motion_difference.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "tests/devices/joint/leg_fixture.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::ElementsAre;

std::string same(const std::string& joint) {
  return joint == "maker/knee" ? "knee" : joint;
}

sim::JointMotion swing(const std::string& knee, double end_s) {
  sim::JointMotion motion;
  motion.name = "swing";
  motion.frame_s = 0.01;
  motion.keys = {{0, "", {{"hip", 0}, {knee, 0}}, {}, "", {}}, {end_s, "", {{"hip", 1}, {knee, 0.5}}, {}, "", {}}};
  return motion;
}

TEST(MotionDifference, IsThatOfTheFramesOfEachJoint) {
  // The hips move from 0 to 1 in 1 s and in 2 s: they differ most at 1 s, by 0.5, and by t/2 before.
  const motion::MotionDifference difference =
      motion::difference_of(swing("knee", 1), swing("maker/knee", 2), 0.1, same);
  ASSERT_EQ(difference.joints.size(), 2u);
  const motion::JointDifference& hip = difference.joints[0];
  EXPECT_EQ(hip.joint, "hip");
  EXPECT_NEAR(hip.max, 0.5, 1e-12);
  EXPECT_NEAR(hip.max_at_s, 1, 1e-12);
  ASSERT_TRUE(hip.first_at_s);
  EXPECT_NEAR(*hip.first_at_s, 0.21, 0.0101);  // the first frame above 0.2 s
  // Mean square of a triangle: a third of its peak squared; the sum of 201 frames differs from it by 0.5 %.
  EXPECT_NEAR(hip.rms, 0.5 / std::sqrt(3.0), 0.005);
  EXPECT_NEAR(difference.joints[1].max, 0.25, 1e-12);
  EXPECT_NEAR(difference.max(), 0.5, 1e-12);
  EXPECT_EQ(difference.first_end_s, 1);
  EXPECT_EQ(difference.second_end_s, 2);
}

TEST(MotionDifference, NamesJointsOfOneMotionOnly) {
  sim::JointMotion first = swing("knee", 1);
  first.keys[0].joints.emplace_back("tail", 0);
  const motion::MotionDifference difference = motion::difference_of(first, swing("ear", 1), 0, same);
  EXPECT_THAT(difference.only_first, ElementsAre("knee", "tail"));
  EXPECT_THAT(difference.only_second, ElementsAre("ear"));
  EXPECT_EQ(difference.joints[0].max, 0);
  EXPECT_FALSE(difference.joints[0].first_at_s);
}

TEST(MotionDifference, OfTheWayOfAVehicleIsADistance) {
  const test_support::ScratchFolder folder;
  motion::StageOptions options;
  options.world = folder.file("world.yaml");
  std::ofstream(options.world) << test::leg_world(
      "        - {name: group, type: joint_group}\n        - {name: player, type: motion_player, group: group}\n");
  const auto still = motion::course_of(options, [] {
    sim::JointMotion motion = swing("knee", 1);
    motion.keys[1].joints = {{"hip", 0}, {"knee", 0}};
    return motion;
  }());
  const auto moved = motion::course_of(options, swing("knee", 1));
  ASSERT_FALSE(still.empty());
  EXPECT_NEAR(still.back().at_s, 1, 1e-9);
  const motion::CourseDifference none = motion::difference_of(still, still);
  EXPECT_EQ(none.max_m, 0);
  EXPECT_NEAR(none.end_at_s, 1, 1e-9);
  const motion::CourseDifference some = motion::difference_of(still, moved);
  // The origin of the vehicle, on the thigh and 1.2 m below its axis, has turned by 1 rad: its chord is 2.4 sin 0.5.
  // The servo lags by less than a frame of 10 ms at 1 rad/s.
  EXPECT_NEAR(some.end_m, 2.4 * std::sin(0.5), 1.2 * 0.01);
  EXPECT_GE(some.max_m, some.rms_m);
}

}  // namespace
