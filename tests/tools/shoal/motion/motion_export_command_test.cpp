// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/called_command.hpp"

namespace {

TEST(MotionExportCommand, NeedsAFormatThatTheEndingDoesNotTell) {
  const test_support::ScratchFolder folder;
  const test::Called called = test::call_shoal({"motion", "export", "wave.yaml", "--output", folder.file("wave.xyz")});
  EXPECT_EQ(called.exit_code, 2);
  EXPECT_THAT(called.err, testing::HasSubstr("--format"));
}

TEST(MotionExportCommand, NeedsAMotion) {
  EXPECT_EQ(test::call_shoal({"motion", "export"}).exit_code, 2);
}

}  // namespace
