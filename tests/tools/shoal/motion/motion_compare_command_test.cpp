// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/tools/shoal/called_command.hpp"
#include "tests/tools/shoal/motion/leg_files.hpp"

namespace {

using testing::ContainsRegex;
using testing::EndsWith;
using testing::HasSubstr;

TEST(MotionCompareCommand, GivesTheGreatestDifferenceItsTimeAndTheRootMeanSquare) {
  const test::LegFiles files;
  const std::string first = files.motion("first", "[{at_s: 0, joints: {knee: 0}}, {at_s: 1, joints: {knee: 10}}]");
  // The servo has another name here, and it is the same joint.
  const std::string second = files.motion(
      "second", "[{at_s: 0, joints: {maker/knee: 0, rod: 0}}, {at_s: 1, joints: {maker/knee: 12, rod: 0}}]");
  const test::Called called = test::call_shoal({"motion", "compare", first, second, "--tolerance", "1.5"});
  EXPECT_EQ(called.exit_code, 1) << called.err;
  // The difference grows by 2 degrees in N = 125 frames of 8 ms, its mean square is 4 (2 N + 1) / (6 N); the frame at
  // 0.752 s is the first one after 0.75 s.
  EXPECT_THAT(called.out, ContainsRegex("\nknee +2\\.0000 +1\\.000 +1\\.1570 +0\\.752\n"));
  EXPECT_THAT(called.out, HasSubstr("only in the second: rod\n"));
  EXPECT_THAT(called.out, EndsWith("1.000 s and 1.000 s; greatest difference 2.0000 deg\nthey differ\n"));
}

}  // namespace
