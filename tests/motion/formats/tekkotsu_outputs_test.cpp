// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/tekkotsu_outputs.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "tests/motion/formats/format_fixture.hpp"

namespace {

using testing::ElementsAre;

TEST(MotFormat, FindsOutputsAsTekkotsu) {
  const test::Read file = test::read("mot",
                                     "#MSq\n# remark\nadvanceTime 99\nLFr:knee~~~ 1\nFr:rotor 0.5\nNECK:roll "
                                     "0\nLED:face 1\ndegrees\nDELAY 100\nLFr:kn 90\n#END\nrubbish",
                                     test::leg_names());
  EXPECT_DOUBLE_EQ(test::value(file.motion, "lf_swing", 0), 0.5) << "a name without L or R sets both sides";
  EXPECT_DOUBLE_EQ(test::value(file.motion, "rf_swing", 0), 0.5);
  EXPECT_DOUBLE_EQ(test::value(file.motion, "lf_knee", 0), 1);
  EXPECT_DOUBLE_EQ(test::value(file.motion, "lf_knee", 0.1), std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(file.motion.start.min_s, 0.1) << "the playhead starts at 1 ms";
  EXPECT_THAT(file.losses, ElementsAre("outputs that vehicle 'leg' does not have are left out: NECK:roll, LED:face"));
}

TEST(MotFormat, HasAtMost200Outputs) {
  std::string text = "#MSq\n";
  for (int i = 0; i < 201; ++i) text += "joint" + std::to_string(i) + " 1\n";
  EXPECT_EQ(test::read_error("mot", text + "#END\n"), "file:202:1: must have at most 200 outputs");
}

}  // namespace
