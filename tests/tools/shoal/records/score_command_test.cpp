// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/called_command.hpp"

namespace {

using testing::HasSubstr;

TEST(ScoreCommand, NeedsALogThatIsThere) {
  EXPECT_THAT(test::call_shoal({"score"}).err, HasSubstr("LOG is required"));
  const test_support::ScratchFolder folder;
  const test::Called called = test::call_shoal({"score", folder.file("missing.lcm")});
  EXPECT_EQ(called.exit_code, 4);
  EXPECT_THAT(called.err, HasSubstr(folder.file("missing.lcm")));
}

TEST(ScoreCommand, AnEstimateIsOfAMetric) {
  const test::Called called = test::call_shoal({"score", "run.lcm", "--metric", "e"});
  EXPECT_EQ(called.exit_code, 2);
  EXPECT_THAT(called.err, HasSubstr("--estimate"));
}

}  // namespace
