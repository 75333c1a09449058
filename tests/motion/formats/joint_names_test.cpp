// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/joint_names.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "tests/motion/formats/format_fixture.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using testing::HasSubstr;

TEST(JointNames, OfTheErs7AreThoseOfSonyAndTekkotsu) {
  const motion::JointNamesFile file =
      motion::load_joint_names(test_support::source_path("vehicles/joint_names/ers7.yaml"));
  EXPECT_EQ(file.vehicle, "ers7");
  ASSERT_EQ(file.lists.size(), 2u);
  EXPECT_EQ(file.lists[0].names.size(), 20u);
  EXPECT_TRUE(file.lists[0].complete);
  EXPECT_EQ(file.lists[0].design, "DRX-1000");
  EXPECT_EQ(file.lists[1].names.size(), 44u) << "18 joints, all but the ears, and 26 lights";
}

TEST(JointNames, OfTheBittleAreNumbersOfOpencat) {
  const motion::JointNamesFile file =
      motion::load_joint_names(test_support::source_path("vehicles/joint_names/bittle.yaml"));
  ASSERT_EQ(file.lists.size(), 1u);
  EXPECT_EQ(file.lists[0].list, "opencat");
  EXPECT_EQ(file.lists[0].names.size(), 9u);
}

TEST(JointNames, AreThoseOfTheListElseOfTheAliasElseOfTheServo) {
  const motion::JointNames names = test::leg_names();
  EXPECT_EQ(names.foreign_name("tekkotsu", false, "lf_knee"), "LFr:knee");
  EXPECT_EQ(names.foreign_name("tekkotsu", false, "PRM:/r2/c1/c2/c3-Joint2:23"), "LFr:knee")
      << "a motion may use the alias";
  EXPECT_EQ(names.foreign_name("webots", true, "lf_knee"), "PRM:/r2/c1/c2/c3-Joint2:23");
  EXPECT_EQ(names.foreign_name("webots", true, "rf_swing"), "rf_swing");
  EXPECT_EQ(names.foreign_name("ros", false, "lf_knee"), "lf_knee");
  EXPECT_EQ(names.joint_of("tekkotsu", "LFr:rotor"), "lf_swing");
  EXPECT_EQ(names.joint_of("webots", "PRM:/r2/c1-Joint2:21"), "lf_swing");
  EXPECT_EQ(names.joint_of("webots", "PRM:/r9"), std::nullopt);
}

TEST(JointNames, SayWhatIsWrongInTheirFile) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("names.yaml");
  std::ofstream(path)
      << "shoal: 1\njoint_names: dog\nlists:\n  - list: a\n    joints: {x: one, y: one, z: [1]}\n    order: 1\n";
  const std::string error = test::error_of([&] { motion::load_joint_names(path); });
  EXPECT_THAT(error, HasSubstr(path + ":5:25: list 1: 'y' must be a name that no other joint has, got 'one'"));
  EXPECT_THAT(error, HasSubstr("'z' must be a name that no other joint has, got [1]"));
  EXPECT_THAT(error, HasSubstr("unknown key 'order'"));
}

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
