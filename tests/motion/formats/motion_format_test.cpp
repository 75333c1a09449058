// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/motion_format.hpp"

#include <gmock/gmock.h>

#include "motion/formats/joint_names.hpp"
#include "motion/formats/mtn_file.hpp"
#include "tests/motion/formats/format_fixture.hpp"

namespace {

using testing::ElementsAre;
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

// Names and notes of other programs that are not text in UTF-8.

const std::string rule = "the name of a joint must be UTF-8 text of 1 to 255 bytes without control characters, got ";

std::string mtn_with(const std::string& name, const std::string& creator = "me") {
  motion::MtnFile file;
  file.name = "wave";
  file.creator = creator;
  file.locators = {"neck", name};
  file.keys.resize(1);
  file.keys[0].joints = {0, 0};
  return motion::mtn_bytes(file);
}

TEST(NamesInOtherFormats, AreTextInUtf8AndTheErrorHasThePlaceAndTheValue) {
  EXPECT_EQ(test::read_error("webots", "#WEBOTS_MOTION,V1.0,hip,caf\xe9\n00:00:000,Pose1,0,0\n"),
            "file:1:25: " + rule + "'caf\\xe9'");
  EXPECT_EQ(test::read_error("csv", "t_s,hip,\xff\n0,0,0\n"), "file:1:9: " + rule + "'\\xff'");
  EXPECT_EQ(test::read_error("mot", "#MSq\nadvanceTime 100\n  h\xc3 0.5\n#END\n"), "file:3:3: " + rule + "'h\\xc3'");
  EXPECT_EQ(test::read_error("pos", "#POS\nh\xc0\x80 0.5\n#END\n"), "file:2:1: " + rule + "'h\\xc0\\x80'");
  EXPECT_EQ(test::read_error("mtn", mtn_with("\xed\xa0\x80")),
            "file: section 2: joint 2: " + rule + "'\\xed\\xa0\\x80'");
  EXPECT_EQ(test::read_error("mtn", mtn_with(std::string("a\0b", 3))),
            "file: section 2: joint 2: " + rule + "'a\\x00b'");
  // With a vehicle too.
  EXPECT_THAT(test::read_error("webots", "#WEBOTS_MOTION,V1.0,caf\xe9\n00:00:000,Pose1,0\n", test::leg_names()),
              HasSubstr("'caf\\xe9'"));
}

TEST(NamesInOtherFormats, HaveAtMost255Bytes) {
  const auto with_name = [](std::size_t size) {
    return "#WEBOTS_MOTION,V1.0," + std::string(size, 'x') + "\n00:00:000,Pose1,0\n";
  };
  EXPECT_EQ(test::read_error("webots", with_name(255)), "");
  EXPECT_THAT(test::read_error("webots", with_name(256)), HasSubstr("1 to 255 bytes"));
}

TEST(NamesInOtherFormats, OfUmlautsAreKept) {
  EXPECT_EQ(test::value(test::read("webots",
                                   "#WEBOTS_MOTION,V1.0,h\xc3\xbc"
                                   "fte\n00:00:000,Pose1,0.5\n")
                            .motion,
                        "h\xc3\xbc"
                        "fte",
                        0),
            0.5);
}

TEST(NotesInOtherFormats, KeepBytesThatAreNotUtf8AsTheirCodes) {
  const test::Read webots = test::read("webots", "#WEBOTS_MOTION,V1.0,hip\n00:00:000,caf\xe9,0\n");
  EXPECT_EQ(webots.motion.keys[0].note, "caf\\xe9");
  EXPECT_THAT(webots.losses, ElementsAre("names of poses with bytes that are not UTF-8, which become '\\xe9': 1"));
  EXPECT_EQ(test::read("mtn", mtn_with("hip", "J\xf6rg")).motion.description, "MTN file of J\\xf6rg for ");
}

}  // namespace
