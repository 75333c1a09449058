// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "sim/config/config_node.hpp"
#include "sim/config/diagnostics.hpp"
#include "tests/sim/config/include_fixture.hpp"

namespace {

using namespace include_fixture;

namespace fs = std::filesystem;

using sim::ConfigNode;
using sim::Diagnostics;

TEST_F(IncludeTest, AFileWithoutIncludeIsItself) {
  write("w.yaml", "a: 1\n");
  EXPECT_EQ(sim::to_yaml(load("w.yaml")), "a: 1\n");
}

TEST_F(IncludeTest, NamesAreRelativeToTheFileThatHoldsThem) {
  write("worlds/common/deep.yaml", "a: 1\n");
  write("worlds/common/base.yaml", "include: deep.yaml\nb: 2\n");
  write("worlds/w.yaml", "include: common/base.yaml\nc: 3\n");
  EXPECT_EQ(sim::to_yaml(load("worlds/w.yaml")), "a: 1\nb: 2\nc: 3\n");
}

TEST_F(IncludeTest, ValuesKeepTheFileTheyCameFrom) {
  write("base.yaml", "a: 1\nm:\n  x: 1\n  y: 2\n");
  write("w.yaml", "include: base.yaml\nm:\n  y: 3\n");
  const ConfigNode root = load("w.yaml");
  EXPECT_EQ(root.find("a")->place.text(), "base.yaml:1:4");
  EXPECT_EQ(root.find("m")->find("x")->place.text(), "base.yaml:3:6");
  EXPECT_EQ(root.find("m")->find("y")->place.text(), "w.yaml:3:6");
}

TEST_F(IncludeTest, OneFileMayBeIncludedOnTwoWays) {
  write("base.yaml", "a: 1\n");
  write("left.yaml", "include: base.yaml\nb: 1\n");
  write("right.yaml", "include: base.yaml\nc: 1\n");
  write("w.yaml", "include: [left.yaml, right.yaml]\n");
  EXPECT_EQ(sim::to_yaml(load("w.yaml")), "a: 1\nb: 1\nc: 1\n");
}

TEST_F(IncludeTest, ReportsAMissingFileWhereItIsNamed) {
  write("w.yaml", "a: 1\ninclude: common/nothing.yaml\n");
  EXPECT_EQ(errors_of("w.yaml"), Lines{"w.yaml:2:10: cannot read 'common/nothing.yaml': No such file or directory"});
  EXPECT_EQ(errors_of("nothing.yaml"), Lines{"nothing.yaml: cannot read the file: No such file or directory"});
}

TEST_F(IncludeTest, ReportsADirectory) {
  fs::create_directory("folder");
  EXPECT_EQ(errors_of("folder"), Lines{"folder: cannot read the file: it is a directory"});
}

TEST_F(IncludeTest, ReportsAnEmptyFile) {
  write("empty.yaml", "# nothing\n");
  EXPECT_EQ(errors_of("empty.yaml"), Lines{"empty.yaml: the file is empty"});
  write("w.yaml", "include: empty.yaml\n");
  EXPECT_EQ(errors_of("w.yaml"), Lines{"empty.yaml: the file is empty"});
}

TEST_F(IncludeTest, ReportsCycles) {
  write("w.yaml", "include: w.yaml\n");
  EXPECT_EQ(errors_of("w.yaml"), Lines{"w.yaml:1:10: 'w.yaml' includes itself"});
  write("a.yaml", "include: b.yaml\n");
  write("b.yaml", "include: ./a.yaml\n");
  EXPECT_EQ(errors_of("a.yaml"), Lines{"b.yaml:1:10: './a.yaml' includes itself"});
}

TEST_F(IncludeTest, ReportsTooManyFiles) {
  // Each includes the next one twice: 2^20 files to read.
  for (int i = 0; i < 20; ++i) {
    const std::string next = "f" + std::to_string(i + 1) + ".yaml";
    write("f" + std::to_string(i) + ".yaml", "include: [" + next + ", " + next + "]\n");
  }
  write("f20.yaml", "a: 1\n");
  const Lines errors = errors_of("f0.yaml");
  ASSERT_FALSE(errors.empty());
  EXPECT_NE(errors[0].find("more than 100 files included"), std::string::npos) << errors[0];
}

TEST_F(IncludeTest, ReportsAnIncludeThatIsNoName) {
  for (const char* value : {"{a: b}", "[[x]]", "~", "''", "[~]"}) {
    write("w.yaml", std::string("include: ") + value + "\n");
    const Lines errors = errors_of("w.yaml");
    ASSERT_EQ(errors.size(), 1u) << value;
    const std::string start = "w.yaml:1:10: 'include' must be a file name or a list of file names, got ";
    EXPECT_EQ(errors[0].substr(0, start.size()), start);
  }
}

TEST_F(IncludeTest, ReportsAnIncludedFileThatIsNoMap) {
  write("base.yaml", "[1, 2]\n");
  write("w.yaml", "include: base.yaml\n");
  EXPECT_EQ(errors_of("w.yaml"), Lines{"base.yaml:1:1: an included file must be a map of keys, got [1, 2]"});
}

TEST_F(IncludeTest, ReportsErrorsOfAllFilesAtTheirPlaces) {
  write("base.yaml", "a: 1\na: 2\n");
  write("other.yaml", "b: [1\n");
  write("w.yaml", "include: [base.yaml, other.yaml]\n");
  const Lines errors = errors_of("w.yaml");
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_EQ(errors[0], "base.yaml:2:1: duplicate key 'a', first at line 1");
  EXPECT_EQ(errors[1].substr(0, 11), "other.yaml:");
}

TEST_F(IncludeTest, ReportsAFileThatIsTooLarge) {
  write("w.yaml", "a: 1\n");
  fs::resize_file("w.yaml", 64'000'001);  // a hole: takes no room on the disk
  EXPECT_EQ(errors_of("w.yaml"), Lines{"w.yaml: the file is larger than 64 MB"});
}

TEST_F(IncludeTest, TheSameBrokenFileTwiceIsNotCalledEmpty) {
  write("w.yaml", "a: 1\na: 2\n");
  Diagnostics diagnostics;
  sim::load_config_file("w.yaml", diagnostics);
  sim::load_config_file("w.yaml", diagnostics);
  EXPECT_EQ(diagnostics.lines(), Lines{"w.yaml:2:1: duplicate key 'a', first at line 1"});
}

std::string value_of_key(const std::string& text, const std::string& path) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode tree = sim::parse_file_text(text, path, diagnostics);
  diagnostics.throw_if_any();
  return tree.find("key")->scalar;
}

TEST(ParsedFiles, GiveTheSameTreeAgain) {
  for (int i = 0; i < 3; ++i) EXPECT_EQ(value_of_key("key: one", "a.yaml"), "one");
}

TEST(ParsedFiles, AreParsedAgainAfterAChange) {
  EXPECT_EQ(value_of_key("key: one", "b.yaml"), "one");
  EXPECT_EQ(value_of_key("key: two", "b.yaml"), "two");
  EXPECT_EQ(value_of_key("key: one", "b.yaml"), "one");
}

TEST(ParsedFiles, HaveTheirOwnPlaces) {
  sim::Diagnostics diagnostics;
  for (const char* path : {"c.yaml", "d.yaml"}) {
    const sim::ConfigNode tree = sim::parse_file_text("\nkey: one", path, diagnostics);
    EXPECT_EQ(tree.find("key")->place.text(), std::string(path) + ":2:6");
  }
}

TEST(ParsedFiles, ReportTheirErrorsEachTime) {
  for (int i = 0; i < 2; ++i) {
    sim::Diagnostics diagnostics;
    sim::parse_file_text("key: [", "e.yaml", diagnostics);
    EXPECT_EQ(diagnostics.lines().size(), 1u);
  }
}

TEST(ParsedFiles, AreKeptInALimitedNumber) {
  for (int round = 0; round < 2; ++round)
    for (int i = 0; i < 100; ++i) {
      const std::string text = std::to_string(i);
      EXPECT_EQ(value_of_key("key: " + text, "f" + text + ".yaml"), text);
    }
}

}  // namespace
