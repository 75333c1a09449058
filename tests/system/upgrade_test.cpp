// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/system/shoal_program.hpp"

namespace {

using namespace system_test;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string old_text =
    "shoal: 1\n"
    "# As fast as the machine can.\n"
    "run: {speed: 0, duration_s: 1}\n"
    "events:\n"
    "  - {name: hello, at: 0.5, do: [{end: enough, passed: true}]}\n";
const std::string new_text =
    "shoal: 1\n"
    "# As fast as the machine can.\n"
    "run: {speed: max, duration_s: 1}\n"
    "events:\n"
    "  - {name: hello, at: 0.5, do: [{end: {reason: enough, passed: true}}]}\n";

Ended upgrade(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "upgrade");
  return run_shoal(std::move(arguments));
}

TEST(Upgrade, ShowsWhatWouldChangeAndWritesNothing) {
  const ScratchFolder folder;
  const std::string path = folder.file("old.yaml");
  write_file(path, old_text);
  const Ended ended = upgrade({"--check", path});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.errors, IsEmpty());
  EXPECT_EQ(ended.output, path +
                              ":3\n"
                              "- run: {speed: 0, duration_s: 1}\n"
                              "+ run: {speed: max, duration_s: 1}\n" +
                              path +
                              ":5\n"
                              "-   - {name: hello, at: 0.5, do: [{end: enough, passed: true}]}\n"
                              "+   - {name: hello, at: 0.5, do: [{end: {reason: enough, passed: true}}]}\n" +
                              path + ": would change in 2 places\n");
  EXPECT_EQ(text_of_file(path), old_text);
}

TEST(Upgrade, RewritesOnce) {
  const ScratchFolder folder;
  const std::string path = folder.file("old.yaml");
  write_file(path, old_text);
  const Ended first = upgrade({path});
  EXPECT_EQ(first.exit_code, 0) << first.errors;
  EXPECT_EQ(first.output, path + ": rewritten in 2 places\n");
  EXPECT_EQ(text_of_file(path), new_text);
  const Ended second = upgrade({path});
  EXPECT_EQ(second.exit_code, 0);
  EXPECT_EQ(second.output, path + ": up to date\n");
  EXPECT_EQ(upgrade({"--check", path}).exit_code, 0);
}

TEST(Upgrade, LeavesAFileInDoubtAloneAndContinuesWithTheOthers) {
  const ScratchFolder folder;
  const std::string doubtful = folder.file("doubtful.yaml"), good = folder.file("good.yaml");
  write_file(doubtful, "shoal: 1\nrun: {speed: &z 0, seed: *z}\n");
  write_file(good, old_text);
  const Ended ended = upgrade({doubtful, good});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(ended.errors,
            doubtful + ":2:14: the rewritten file would not mean the same here; the file is left as it is\n");
  EXPECT_EQ(text_of_file(doubtful), "shoal: 1\nrun: {speed: &z 0, seed: *z}\n");
  EXPECT_EQ(text_of_file(good), new_text);
}

TEST(Upgrade, NeedsAFile) {
  EXPECT_EQ(upgrade({}).exit_code, 2);
  const Ended ended = upgrade({"nowhere.yaml"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.errors, HasSubstr("nowhere.yaml: cannot read the file: No such file or directory"));
}

}  // namespace
