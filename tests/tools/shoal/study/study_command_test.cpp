// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/called_command.hpp"

namespace {

using testing::HasSubstr;

TEST(StudyCommand, AStudyThatIsNotThereIsNamed) {
  const test_support::ScratchFolder folder;
  const test::Called called = test::call_shoal({"study", "plan", folder.file("missing.yaml")});
  EXPECT_NE(called.exit_code, 0);
  EXPECT_THAT(called.err, HasSubstr("missing.yaml"));
}

TEST(StudyCommand, SeedsAreNumbersAndRanges) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("w.yaml")) << "shoal: 1\n";
  std::ofstream(folder.file("s.yaml")) << "study: s\nworld: w.yaml\nseeds: 1\ncases: [{name: a}]\n";
  const test::Called called = test::call_shoal({"study", "plan", folder.file("s.yaml"), "--seeds", "3-"});
  EXPECT_EQ(called.exit_code, 2);
  EXPECT_THAT(called.err, HasSubstr("--seeds"));
}

}  // namespace
