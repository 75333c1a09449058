// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/called_command.hpp"

namespace {

using testing::HasSubstr;

TEST(ReportCommand, SaysWhatIsNoResultsFolder) {
  const test_support::ScratchFolder folder;
  const test::Called called = test::call_shoal({"report", folder.file("missing")});
  EXPECT_EQ(called.exit_code, 4);
  EXPECT_THAT(called.err, HasSubstr(folder.file("missing")));
}

TEST(ReportCommand, NeedsAFolder) {
  EXPECT_EQ(test::call_shoal({"report"}).exit_code, 2);
}

}  // namespace
