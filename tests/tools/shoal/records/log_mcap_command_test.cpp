// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/tools/shoal/called_command.hpp"
#include "tests/viewer/server/log_page.hpp"

namespace {

using testing::HasSubstr;

TEST(LogMcapCommand, ConvertsALog) {
  const test::FallLog log;
  const std::string out = log.folder.file("run.mcap");
  const test::Called called = test::call_shoal({"log", "mcap", log.path, "--out", out, "--channels", "sim[.].*"});
  EXPECT_EQ(called.exit_code, 0) << called.err;
  EXPECT_GT(std::filesystem::file_size(out), 1000u);
}

TEST(LogMcapCommand, SaysWhatIsWrongWithItsOptions) {
  const test::FallLog log;
  const auto wrong = [&](const std::string& out, const std::string& channels) {
    const test::Called called = test::call_shoal({"log", "mcap", log.path, "--out", out, "--channels", channels});
    EXPECT_EQ(called.exit_code, 2);
    return called.err;
  };
  EXPECT_THAT(wrong(log.folder.file("run.bag"), "a"), HasSubstr("--out: must end in .mcap, got"));
  EXPECT_THAT(wrong(log.folder.file("run.mcap"), "(a"), HasSubstr("'(a' is not a regular expression"));
  EXPECT_THAT(wrong(log.path, "a"), HasSubstr("--out: must not be the log"));
}

}  // namespace
