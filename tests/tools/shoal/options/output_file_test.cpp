// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/options/output_file.hpp"

#include <gtest/gtest.h>

#include "tests/scratch_folder.hpp"

namespace {

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
