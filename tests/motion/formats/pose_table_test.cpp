// SPDX-License-Identifier: BSD-3-Clause
#include "motion/formats/pose_table.hpp"

#include <gmock/gmock.h>

#include "tests/motion/formats/format_fixture.hpp"

namespace {

using testing::IsEmpty;

TEST(PosFormat, ReadsThePartsThatAreOutputs) {
  const test::Read file = test::read("pos",
                                     "#POS\n<meta-info>\n timestamp 12\n</meta-info>\nLFr:rotor = -0.79 1.00 # "
                                     "remark\n<sensors>\nIR 5\n</sensors>\n#END\n",
                                     test::leg_names());
  EXPECT_DOUBLE_EQ(test::value(file.motion, "lf_swing", 0), -0.79);
  EXPECT_THAT(file.losses, IsEmpty());
  EXPECT_EQ(
      test::read_error("pos", "#POS\ncondensed ERS-7\n#END\n", test::leg_names()),
      "file:2:1: postures for a single robot model are not supported: must be a name of an output, got 'condensed'");
}

}  // namespace
