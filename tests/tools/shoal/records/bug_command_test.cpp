// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/called_command.hpp"

namespace {

using testing::HasSubstr;

TEST(BugCommand, NeedsTheFolderOfARun) {
  EXPECT_THAT(test::call_shoal({"bug"}).err, HasSubstr("RUN is required"));
  const test_support::ScratchFolder folder;
  const test::Called called = test::call_shoal({"bug", folder.file("missing")});
  EXPECT_EQ(called.exit_code, 4);
  EXPECT_THAT(called.err, testing::AllOf(testing::StartsWith("shoal: "), HasSubstr(folder.file("missing"))));
}

TEST(BugCommand, LimitsAreNumbersAboveZero) {
  for (const char* option : {"--last-s", "--max-mb"}) {
    const test::Called called = test::call_shoal({"bug", "x", option, "-1"});
    EXPECT_EQ(called.exit_code, 2) << option;
    EXPECT_THAT(called.err, HasSubstr(option));
  }
}

}  // namespace
