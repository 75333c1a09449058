// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/called_command.hpp"

namespace {

using testing::HasSubstr;

/// A hip that swings within a second.
std::string swing(const test_support::ScratchFolder& folder) {
  std::ofstream(folder.file("swing.yaml")) << "shoal: 1\nmotion: swing\nvehicle: dog\n"
                                              "keys: [{at_s: 0, joints: {hip: 0}}, {at_s: 1, joints: {hip: 0.2}}]\n";
  return folder.file("swing.yaml");
}

TEST(MotionShowCommand, ShowsJointsAndTimes) {
  const test_support::ScratchFolder folder;
  const test::Called called = test::call_shoal({"motion", "show", swing(folder)});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_THAT(called.out, testing::AllOf(HasSubstr("swing"), HasSubstr("hip")));
}

TEST(MotionShowCommand, SaysWhatIsWrongWithAMotion) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("bad.yaml")) << "shoal: 1\nmotion: bad\nkeys: 3\n";
  const test::Called called = test::call_shoal({"motion", "show", folder.file("bad.yaml")});
  EXPECT_EQ(called.exit_code, 2);
  EXPECT_THAT(called.err, HasSubstr("'keys'"));
}

}  // namespace
