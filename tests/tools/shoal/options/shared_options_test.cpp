// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/options/shared_options.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "tests/scratch_folder.hpp"

namespace {

TEST(SpeedOption, IsAMultipleOfRealTimeOrTheMost) {
  EXPECT_EQ(tools::parse_speed("2.5"), 2.5);
  EXPECT_EQ(tools::parse_speed("0.001"), 0.001);
  EXPECT_EQ(tools::parse_speed("max"), 0);
  EXPECT_FALSE(tools::parse_speed(""));
}

TEST(SpeedOption, OtherTextsAreWrongUsage) {
  for (const char* text : {"0", "-1", "2e6", "fast", "2x", "nan", "Max"}) {
    try {
      tools::parse_speed(text);
      ADD_FAILURE() << text;
    } catch (const CLI::ValidationError& error) {
      EXPECT_STREQ(error.what(),
                   (std::string("--speed: must be from 0.001 to 1e6, or max, got '") + text + "'").c_str());
    }
  }
}

std::string problem_of(const std::string& path) {
  try {
    tools::check_writable(path);
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(OutputFile, ThatCannotBeWrittenIsFoundBeforeTheWork) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("out.png");
  EXPECT_EQ(problem_of(path), "");
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(problem_of("out.png"), "");
  EXPECT_EQ(problem_of("/nowhere/out.png"), "/nowhere/out.png: cannot be written: no such folder");
  std::filesystem::create_directory(path);
  EXPECT_EQ(problem_of(path), path + ": cannot be written: it is a folder");
}

}  // namespace
