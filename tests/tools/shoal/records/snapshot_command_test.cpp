// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/called_command.hpp"

namespace {

using testing::HasSubstr;

TEST(SnapshotCommand, NeedsAFile) {
  const test::Called called = test::call_shoal({"snapshot"});
  EXPECT_EQ(called.exit_code, 2);
  EXPECT_THAT(called.err, HasSubstr("FILE is required"));
}

TEST(SnapshotCommand, SaysWhatIsNoSnapshot) {
  const test_support::ScratchFolder folder;
  std::ofstream(folder.file("no.snapshot")) << "something else";
  for (const char* name : {"no.snapshot", "missing.snapshot"}) {
    const test::Called called = test::call_shoal({"snapshot", folder.file(name)});
    EXPECT_EQ(called.exit_code, 4) << name;
    EXPECT_THAT(called.err, HasSubstr(folder.file(name)));
  }
}

}  // namespace
