// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/motion_format.hpp"

#include <gmock/gmock.h>

#include "motion/formats/joint_names.hpp"
#include "tests/motion/formats/format_fixture.hpp"

namespace {

using testing::HasSubstr;

TEST(MotionFormats, AreFoundByTheirFirstBytesElseByTheEnding) {
  EXPECT_STREQ(motion::motion_format_of_file("x", "OMTN....")->name, "mtn");
  EXPECT_STREQ(motion::motion_format_of_file("x.csv", "#MSq\n")->name, "mot");
  EXPECT_STREQ(motion::motion_format_of_file("x.motion", "")->name, "webots");
  EXPECT_EQ(motion::motion_format_of_file("x.yaml", "joint_names:"), nullptr);
  EXPECT_EQ(motion::find_motion_format("bvh"), nullptr);
}

TEST(MotionFormats, ListWhatTheyNeverKeep) {
  sim::JointMotion motion = test::motion({{0, {{"a", 0}}, {}, "note"}, {0.8, {{"a", 1}}}});
  motion.description = "text";
  motion.loop = true;
  motion.poses.push_back({"stand", {{"a", 0}}});
  motion.changes.emplace_back();
  motion.start.min_s = 2;
  motion.recorded.emplace();
  EXPECT_THAT(test::written("csv", motion).losses,
              testing::ElementsAre("the description is not kept", "names of 1 pose are not kept; their values are",
                                   "1 note of keys are not kept", HasSubstr("one cycle of the loop"),
                                   "1 change of the world are not kept", "the place of the recording is not kept",
                                   HasSubstr("'start' is not kept")));
}

}  // namespace
