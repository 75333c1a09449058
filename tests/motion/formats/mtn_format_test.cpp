// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "motion/formats/mtn_file.hpp"
#include "tests/motion/formats/format_fixture.hpp"
#include "tests/motion/formats/mtn_format_fixture.hpp"

namespace {

using namespace mtn_format_fixture;

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(MtnFormat, ReadsAndWritesTheSameBytesByWayOfAMotion) {
  const std::string bytes = example();
  const test::Read read = test::read("mtn", bytes);
  // (61 + 51 + 41 + 51 + 101) * 16 ms.
  EXPECT_DOUBLE_EQ(read.motion.end_s(), 4.88);
  EXPECT_EQ(read.motion.name, "b_stand_lie_S");
  EXPECT_EQ(read.motion.keys[0].note, "body roll 0 pitch 34906 yaw 0 (1e-6 rad)");
  EXPECT_THAT(read.losses, ElementsAre("the name 'b_stand#lie_S' becomes 'b_stand_lie_S'"));
  motion::FormatOptions options;
  options.name = "b_stand#lie_S";
  options.creator = "Makers of Shoal.";
  options.design = "XYZ-910";
  EXPECT_EQ(test::written("mtn", read.motion, {}, options).bytes, bytes);
}

TEST(MtnFormat, CountsTheFramesBetweenKeysAndRoundsToMicroradians) {
  const test::Written file =
      test::written("mtn", test::motion({{0, {{"a", 0.1234567}}}, {0.016, {{"a", -1}}}, {0.176, {{"a", 1}}}}));
  const motion::MtnFile read = motion::parse_mtn(file.bytes, "file");
  ASSERT_EQ(read.keys.size(), 3u);
  EXPECT_EQ(read.keys[0].joints[0], 123457);
  EXPECT_EQ(read.keys[1].between, 0);
  EXPECT_EQ(read.keys[2].between, 9);
  EXPECT_EQ(read.name, "wave");
  EXPECT_EQ(read.creator, "Shoal");
  EXPECT_THAT(file.losses, IsEmpty());
}

TEST(MtnFormat, ListsHowFarTimesBetweenFramesMoveTheMotion) {
  // The corner at 24 ms lies in the middle of two frames of 16 ms: they miss half of the way to it.
  const test::Written file =
      test::written("mtn", test::motion({{0, {{"a", 0}}}, {0.024, {{"a", 0}}}, {0.04, {{"a", 1}}}}));
  EXPECT_THAT(file.losses,
              ElementsAre("times are rounded to whole 16 ms; at its frames up to 0.25 rad from the motion, joint 'a'"));
}

TEST(MtnFormat, WritesAllJointsOfACompleteListInItsOrder) {
  const motion::JointNames names("leg", {{"knee", "", 0.5, false}, {"hip", "", 0, false}, {"ear", "", 0, false}},
                                 {{"open-r", "DRX-1000", true, {{"hip", "PRM:1"}, {"knee", "PRM:2"}}}});
  const test::Written file = test::written("mtn", test::motion({{0, {{"ear", 1}, {"hip", 0.25}}}}), names);
  const motion::MtnFile read = motion::parse_mtn(file.bytes, "file");
  EXPECT_EQ(read.design, "DRX-1000");
  EXPECT_THAT(read.locators, ElementsAre("PRM:1", "PRM:2"));
  EXPECT_THAT(read.keys[0].joints, ElementsAre(250000, 500000));
  EXPECT_THAT(file.losses, ElementsAre("joints that have no name in this format are left out: ear",
                                       "joints that the motion does not name stay at rest: knee"));
}

TEST(MtnFormat, RefusesWhatItCannotHold) {
  sim::JointMotion slider = test::motion({{0, {{"a", 1}}}});
  slider.sliders = {"a"};
  EXPECT_EQ(test::error_of([&] { test::written("mtn", slider); }),
            "motion 'wave': joint 'a' is a slider, and the format holds only angles");
  EXPECT_EQ(test::error_of([&] {
              test::written("mtn", test::motion({{0, {{"a", 3000}}}}));
            }),
            "motion 'wave': joint 'a' at 0 s: must be from -2147 to 2147, got 3000");
  motion::FormatOptions options;
  options.name = std::string(128, 'x');
  EXPECT_THAT(test::error_of([&] {
                test::written("mtn", test::motion({{0, {{"a", 0}}}}), {}, options);
              }),
              HasSubstr("the name must have at most 127 bytes"));
}

TEST(MtnFormat, SaysAtWhichByteWhatIsWrong) {
  const std::string bytes = example();
  const auto changed = [&](std::size_t at, char value) {
    std::string copy = bytes;
    copy[at] = value;
    return test::read_error("mtn", copy);
  };
  EXPECT_EQ(changed(0, 'X'), "file: byte 0: must start with 'OMTN'");
  EXPECT_EQ(changed(16, 2), "file: byte 16: the major version must be 1, got 2");
  EXPECT_EQ(changed(20, 0), "file: byte 20: the number of keys must be at least 1, got 0");
  EXPECT_EQ(changed(22, 8), "file: byte 22: the time of a frame in ms must be 16, got 8");
  EXPECT_EQ(changed(32, 49),
            "file: byte 32: the size of section 1 must be a multiple of 4 up to the end of the file, got 49");
  EXPECT_EQ(changed(75, 1), "file: byte 75: a byte after the texts of the section must be 0, got 1");
  EXPECT_EQ(changed(20, 7), "file: byte 592: 7 keys of 20 joints need 668 bytes, and the section has 572");
  EXPECT_EQ(test::read_error("mtn", bytes + "x"), "file: byte 1164: must end here, and 1 bytes follow");
  EXPECT_EQ(test::read_error("mtn", bytes.substr(0, 600)),
            "file: byte 584: the size of section 3 must be a multiple of 4 up to the end of the file, got 584");
  // The number of frames before key 1.
  EXPECT_EQ(changed(592 + 92 + 3, -1), "file: byte 684: the number of frames must be >= 0, got -16777156");
}

}  // namespace
