// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/upgrade/upgrade_file.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/scratch_folder.hpp"

namespace {

namespace fs = std::filesystem;
using test_support::ScratchFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using tools::FileUpgrade;
using State = FileUpgrade::State;

const std::string old_text = "shoal: 1\nrun: {speed: 0}\n";
const std::string new_text = "shoal: 1\nrun: {speed: max}\n";

void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

FileUpgrade plan(const std::string& path) {
  const std::vector<FileUpgrade> files = tools::plan_upgrade({path});
  return files.at(0);
}

/// Why a file cannot be written; empty: it was.
std::string write_error(const FileUpgrade& file) {
  try {
    tools::write_upgrade(file);
    return "";
  } catch (const sim::ConfigError& error) {
    return error.what();
  }
}

TEST(UpgradeFile, PlansWithoutWriting) {
  const ScratchFolder folder;
  write(folder.file("a.yaml"), old_text);
  const FileUpgrade file = plan(folder.file("a.yaml"));
  EXPECT_EQ(file.state, State::changes);
  EXPECT_EQ(file.upgraded.text, new_text);
  EXPECT_EQ(text_of(folder.file("a.yaml")), old_text);
}

TEST(UpgradeFile, WritesInPlaceAndLeavesNothingElse) {
  const ScratchFolder folder;
  const std::string path = folder.file("a.yaml");
  write(path, old_text);
  fs::permissions(path, fs::perms(0640));
  EXPECT_EQ(write_error(plan(path)), "");
  EXPECT_EQ(text_of(path), new_text);
  EXPECT_EQ(fs::status(path).permissions(), fs::perms(0640));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.file("")), fs::directory_iterator()), 1);
  EXPECT_EQ(plan(path).state, State::up_to_date);
}

TEST(UpgradeFile, ASymbolicLinkStays) {
  const ScratchFolder folder;
  fs::create_directory(folder.file("b"));
  write(folder.file("b/a.yaml"), old_text);
  fs::create_symlink("b/a.yaml", folder.file("link.yaml"));
  EXPECT_EQ(write_error(plan(folder.file("link.yaml"))), "");
  EXPECT_TRUE(fs::is_symlink(folder.file("link.yaml")));
  EXPECT_EQ(text_of(folder.file("b/a.yaml")), new_text);
}

TEST(UpgradeFile, AFileWithTwoNamesIsLeftAlone) {
  const ScratchFolder folder;
  write(folder.file("a.yaml"), old_text);
  fs::create_hard_link(folder.file("a.yaml"), folder.file("b.yaml"));
  EXPECT_EQ(write_error(plan(folder.file("a.yaml"))),
            folder.file("a.yaml") + ": cannot be written: it has more than one hard link");
  EXPECT_EQ(text_of(folder.file("a.yaml")), old_text);
}

TEST(UpgradeFile, AFileThatSomeOneElseChangedIsLeftAlone) {
  const ScratchFolder folder;
  write(folder.file("a.yaml"), old_text);
  const FileUpgrade file = plan(folder.file("a.yaml"));
  write(folder.file("a.yaml"), old_text + "# mine\n");
  EXPECT_THAT(write_error(file), HasSubstr("it has changed since it was read"));
  EXPECT_EQ(text_of(folder.file("a.yaml")), old_text + "# mine\n");
  fs::remove(folder.file("a.yaml"));
  EXPECT_THAT(write_error(file), HasSubstr("it does not exist any more"));
}

TEST(UpgradeFile, AFileThatMayNotBeWrittenIsLeftAlone) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everything";
  const ScratchFolder folder;
  write(folder.file("a.yaml"), old_text);
  fs::permissions(folder.file("a.yaml"), fs::perms(0440));
  EXPECT_THAT(write_error(plan(folder.file("a.yaml"))), HasSubstr("cannot be written: Permission denied"));
}

TEST(UpgradeFile, ContinuesToWhatAFileIncludes) {
  const ScratchFolder folder;
  fs::create_directory(folder.file("b"));
  write(folder.file("a.yaml"), "include: [b/c.yaml, b/d.yaml]\nshoal: 1\n");
  write(folder.file("b/c.yaml"), "include: d.yaml\nevents: [{name: e, times: 0}]\n");
  write(folder.file("b/d.yaml"), "state_rate_hz: 5\nevents: [{name: f, times: 0}]\n");
  std::vector<std::string> paths;
  std::vector<State> states;
  for (const FileUpgrade& file : tools::plan_upgrade({folder.file("a.yaml"), folder.file("b/../a.yaml")})) {
    paths.push_back(file.path);
    states.push_back(file.state);
  }
  EXPECT_THAT(paths, ElementsAre(folder.file("a.yaml"), folder.file("b/c.yaml"), folder.file("b/d.yaml")));
  EXPECT_THAT(states, ElementsAre(State::up_to_date, State::changes, State::changes));
}

TEST(UpgradeFile, ElsewhereIsLeftAloneUnlessItIsNamed) {
  const ScratchFolder folder;
  fs::create_directory(folder.file("w"));
  write(folder.file("x.yaml"), "run: {speed: 0}\n");
  write(folder.file("w/a.yaml"), "include: ../x.yaml\nshoal: 1\n");
  fs::create_symlink("../x.yaml", folder.file("w/link.yaml"));
  write(folder.file("w/b.yaml"), "shoal: 1\ninclude: [" + folder.file("x.yaml") + ", link.yaml]\n");
  const char* rule = "must lie below the folder of a file on the command line, or be one of these files";
  for (const char* name : {"w/a.yaml", "w/b.yaml"}) {
    const auto files = tools::plan_upgrade({folder.file(name)});
    ASSERT_EQ(files.size(), 1u) << name;
    EXPECT_EQ(files[0].state, State::refused) << name;
    EXPECT_THAT(files[0].errors[0], HasSubstr(rule)) << name;
  }
  EXPECT_EQ(tools::plan_upgrade({folder.file("w/a.yaml"), folder.file("x.yaml")}).size(), 2u);
}

TEST(UpgradeFile, ThatIncludesItselfIsReadOnce) {
  const ScratchFolder folder;
  write(folder.file("a.yaml"), "include: a.yaml\nrun: {speed: 0}\n");
  EXPECT_EQ(tools::plan_upgrade({folder.file("a.yaml")}).size(), 1u);
}

TEST(UpgradeFile, OneThatIsRefusedKeepsNoOtherBack) {
  const ScratchFolder folder;
  write(folder.file("a.yaml"), "include: b.yaml\nrun: {speed: 0}\n");
  write(folder.file("b.yaml"), "run: {speed: &z 0, seed: *z}\n");
  const auto files = tools::plan_upgrade({folder.file("a.yaml")});
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0].state, State::changes);
  EXPECT_EQ(files[1].state, State::refused);
  EXPECT_THAT(files[1].errors, ElementsAre(HasSubstr("b.yaml:1:14: ")));
}

TEST(UpgradeFile, SaysWhyAFileCannotBeRead) {
  const ScratchFolder folder;
  const auto error = [&](const std::string& name) { return plan(folder.file(name)).errors.at(0); };
  EXPECT_EQ(error("none.yaml"), folder.file("none.yaml") + ": cannot read the file: No such file or directory");
  EXPECT_EQ(error(""), folder.file("") + ": cannot read the file: it is a directory");
  ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
  EXPECT_THAT(error("pipe"), HasSubstr("it is not a regular file"));
  write(folder.file("empty.yaml"), "# nothing\n");
  EXPECT_THAT(error("empty.yaml"), HasSubstr("the file is empty"));
  write(folder.file("list.yaml"), "- a\n");
  EXPECT_THAT(error("list.yaml"), HasSubstr("list.yaml:1:1: must be a map of keys and values, got [a]"));
  write(folder.file("other.yaml"), "a: 1\n");
  EXPECT_THAT(error("other.yaml"), HasSubstr("must be a world, a vehicle or a study"));
  write(folder.file("a.yaml"), "shoal: 1\ninclude: b.yaml\n");
  EXPECT_THAT(tools::plan_upgrade({folder.file("a.yaml")}).at(1).errors.at(0),
              testing::AllOf(HasSubstr("a.yaml:2:10: cannot read"), HasSubstr("No such file")));
}

}  // namespace
