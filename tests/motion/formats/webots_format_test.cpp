// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/motion/formats/format_fixture.hpp"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

sim::JointMotion there_and_back() {
  return test::motion({{0, {{"lf_swing", 0}, {"lf_knee", 0.5}}, {}, "stand"},
                       {0.8, {{"lf_swing", 0.25}}, {}, "lift, high"},
                       {61.6, {{"lf_swing", 0}, {"lf_knee", 0.5}}}});
}

TEST(WebotsFormat, WritesAllJointsInEachPose) {
  const test::Written file = test::written("webots", there_and_back(), test::leg_names());
  EXPECT_EQ(file.bytes,
            "#WEBOTS_MOTION,V1.0,PRM:/r2/c1-Joint2:21,PRM:/r2/c1/c2/c3-Joint2:23\n"
            "00:00:000,stand,0.000000,0.500000\n"
            "00:00:800,lift high,0.250000,0.500000\n"
            "01:01:600,Pose3,0.000000,0.500000\n");
  EXPECT_THAT(file.losses, IsEmpty());
}

TEST(WebotsFormat, EndsALoopOneControlStepEarlySinceThePlayerAddsOne) {
  sim::JointMotion motion = test::motion({{0, {{"a", 0}}}, {0.064, {{"a", 0.64}}}, {0.128, {{"a", 0}}}});
  motion.loop = true;
  motion::FormatOptions options;
  options.loop_step_s = 0.032;
  // The loop of 128 ms has poses at 0, 32, 64 and 96 ms; the fifth step of 32 ms is the first one again.
  EXPECT_EQ(test::written("webots", motion, {}, options).bytes,
            "#WEBOTS_MOTION,V1.0,a\n00:00:000,Pose1,0.000000\n00:00:064,Pose2,0.640000\n00:00:096,Pose3,0.320000\n");
  const test::Read again = test::read("webots", test::written("webots", motion, {}, options).bytes, {}, options);
  EXPECT_TRUE(again.motion.loop);
  EXPECT_DOUBLE_EQ(again.motion.end_s(), 0.128);
  EXPECT_NEAR(test::value(again.motion, "a", 0.112), 0.16, 1e-12);
}

TEST(WebotsFormat, RefusesALoopThatIsNotWholeControlSteps) {
  sim::JointMotion motion = test::motion({{0, {{"a", 0}}}, {0.1, {{"a", 0}}}});
  motion.loop = true;
  motion::FormatOptions options;
  options.loop_step_s = 0.032;
  EXPECT_EQ(test::error_of([&] { test::written("webots", motion, {}, options); }),
            "motion 'wave': a loop must last two or more whole control steps of 32 ms (--loop-step-ms), got 0.1 s");
}

TEST(WebotsFormat, ListsTheSeamOfALoopThatDoesNotClose) {
  sim::JointMotion motion = test::motion({{0, {{"a", 0}}}, {0.128, {{"a", 0.25}}}});
  motion.loop = true;
  motion::FormatOptions options;
  options.loop_step_s = 0.032;
  EXPECT_THAT(test::written("webots", motion, {}, options).losses,
              ElementsAre(HasSubstr("up to 0.25 rad from the first one")));
}

TEST(WebotsFormat, SamplesEasingAtTheFramesOfTheMotion) {
  const sim::JointMotion motion = test::motion({{0, {{"a", 0}}}, {0.032, {{"a", 1}}, sim::Easing::cosine}});
  const test::Written file = test::written("webots", motion);
  // (1 - cos(pi k / 4)) / 2 for k = 0...4.
  EXPECT_EQ(file.bytes,
            "#WEBOTS_MOTION,V1.0,a\n00:00:000,Pose1,0.000000\n00:00:008,Pose2,0.146447\n00:00:016,Pose3,0.500000\n"
            "00:00:024,Pose4,0.853553\n00:00:032,Pose5,1.000000\n");
  EXPECT_THAT(file.losses, ElementsAre("easing is sampled every 8 ms; at its frames the motion is exact"));
}

TEST(WebotsFormat, PutsAKeyBetweenTwoMillisecondsAtBoth) {
  const test::Written file =
      test::written("webots", test::motion({{0, {{"a", 0}}}, {0.0105, {{"a", 1}}}, {0.02, {{"a", 1}}}}));
  // 10 / 10.5 = 0.952381 of the way.
  EXPECT_THAT(file.bytes, HasSubstr("00:00:010,Pose2,0.952381\n00:00:011,Pose3,1.000000\n"));
  EXPECT_THAT(file.losses,
              ElementsAre(HasSubstr("times are rounded to whole 1 ms; at its frames the motion is exact")));
}

TEST(WebotsFormat, HoldsAJointWhereTheFileHasAStar) {
  const test::Read file =
      test::read("webots", "#WEBOTS_MOTION,V1.0,a,b,c\r\n100,p,1,*,*\r\n1:100,q,*,2,*\r\n1:0:200,r,3,4,*\r\n");
  EXPECT_DOUBLE_EQ(file.motion.end_s(), 60.2);
  EXPECT_DOUBLE_EQ(test::value(file.motion, "a", 30), 1) << "not driven: the last command holds";
  EXPECT_DOUBLE_EQ(test::value(file.motion, "a", 60.2), 3);
  EXPECT_DOUBLE_EQ(test::value(file.motion, "b", 0), 2);
  EXPECT_NEAR(test::value(file.motion, "b", (1.1 + 60.2) / 2), 3, 1e-12);
  EXPECT_THAT(file.losses, ElementsAre("joint 'a' holds its position where the file has '*'",
                                       "joint 'b' holds its position where the file has '*'",
                                       "joint 'c' has no position: left out"));
}

TEST(WebotsFormat, ReadsNothingAfterAnEmptyLineAsThePlayer) {
  const test::Read file = test::read("webots", "#WEBOTS_MOTION,V1.0,a\n0,p,1\n\n8,q,2\n");
  EXPECT_DOUBLE_EQ(file.motion.end_s(), 0);
  EXPECT_THAT(file.losses, ElementsAre(HasSubstr("line 4 and all after it are not read")));
}

TEST(WebotsFormat, SaysWhereAndWhatIsWrong) {
  const std::string head = "#WEBOTS_MOTION,V1.0,a,b\n";
  const auto error = [](const std::string& text) { return test::read_error("webots", text); };
  EXPECT_EQ(error(""), "file:1:1: must start with '#WEBOTS_MOTION,V1.0'");
  EXPECT_EQ(error("WEBOTS,V1.0,a\n"), "file:1:1: must start with '#WEBOTS_MOTION', got 'WEBOTS'");
  EXPECT_EQ(error("#WEBOTS_MOTION,V2,a\n"), "file:1:16: the version must be 'V1.0', got 'V2'");
  EXPECT_EQ(error("#WEBOTS_MOTION,V1.0,a,,b\n"), "file:1:23: needs the name of a device");
  EXPECT_EQ(error("#WEBOTS_MOTION,V1.0,a,a\n"), "file:1:23: names a device twice, got 'a'");
  EXPECT_EQ(error(head), "file:1:1: needs a line with a pose after the names of devices");
  EXPECT_EQ(error(head + "0,p,1\n"), "file:2:1: must have a time, a name and 2 values, got 3 words");
  EXPECT_EQ(error(head + "0,,1,2\n"), "file:2:3: needs the name of the pose");
  EXPECT_EQ(error(head + "0:0:0:8,p,1,2\n"),
            "file:2:1: the time must be [[minutes:]seconds:]milliseconds, got '0:0:0:8'");
  EXPECT_EQ(error(head + "8,p,1,2\n8,q,1,2\n"), "file:3:1: times must increase, got '8'");
  EXPECT_EQ(error(head + "0,p,1,two\n"), "file:2:7: a position must be a number from -1000000 to 1000000, got 'two'");
  EXPECT_EQ(error(head + "0,p,1,nan\n"), "file:2:7: a position must be a number from -1000000 to 1000000, got 'nan'");
  EXPECT_EQ(error(head + std::string(4095, 'x')), "file:2:4095: a line must have at most 4094 bytes");
  EXPECT_EQ(error(head + "0,p,*,*\n"), "file: no device has a position");
}

TEST(WebotsFormat, NamesTheJointsThatAVehicleHas) {
  EXPECT_EQ(test::read_error("webots", "#WEBOTS_MOTION,V1.0,lf_kne\n0,p,1\n", test::leg_names()),
            "file:1:21: joint 'lf_kne' is unknown to vehicle 'leg'; did you mean 'lf_knee'?; known: lf_swing, lf_knee, "
            "rf_swing");
  const sim::JointMotion motion = test::motion({{0, {{"lf_kne", 0}}}});
  EXPECT_EQ(test::error_of([&] { test::written("webots", motion, test::leg_names()); }),
            "joint 'lf_kne' is not a joint servo of vehicle 'leg'; did you mean 'lf_knee'?; known: lf_swing, lf_knee, "
            "rf_swing");
}

}  // namespace
