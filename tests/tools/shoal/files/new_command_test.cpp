// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/scratch_folder.hpp"
#include "tests/tools/shoal/called_command.hpp"

namespace {

using testing::HasSubstr;

TEST(NewCommand, WritesFilesThatAreGood) {
  const test_support::ScratchFolder folder;
  for (const char* kind : {"world", "vehicle"}) {
    const test::Called called = test::call_shoal({"new", kind, "mine", "--folder", folder.file(kind)});
    EXPECT_EQ(called.exit_code, 4) << "without the folder";
    std::filesystem::create_directory(folder.file(kind));
    EXPECT_EQ(test::call_shoal({"new", kind, "mine", "--folder", folder.file(kind)}).exit_code, 0) << kind;
    EXPECT_EQ(test::call_shoal({"check", folder.file(kind) + "/mine.yaml"}).exit_code, 0) << kind;
  }
}

TEST(NewCommand, ReplacesNothing) {
  const test_support::ScratchFolder folder;
  const std::vector<std::string> call{"new", "vehicle", "mine", "--folder", folder.file("")};
  ASSERT_EQ(test::call_shoal(call).exit_code, 0);
  const test::Called called = test::call_shoal(call);
  EXPECT_EQ(called.exit_code, 4);
  EXPECT_THAT(called.err, HasSubstr("already exists; choose another name or folder"));
}

TEST(NewCommand, NeedsAKindAndAName) {
  EXPECT_EQ(test::call_shoal({"new"}).exit_code, 2);
  EXPECT_THAT(test::call_shoal({"new", "vehicle"}).err, HasSubstr("NAME is required"));
}

}  // namespace
