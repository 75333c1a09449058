// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/run_key_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "tests/scratch_folder.hpp"

namespace {

namespace fs = std::filesystem;

std::string key_in(const fs::path& folder) {
  std::ifstream file(folder / bridges::run_key_file);
  std::string text;
  std::getline(file, text);
  return text;
}

TEST(RunKeyFile, OnlyItsUserCanReadItWhileTheRunLasts) {
  const test_support::ScratchFolder scratch;
  const fs::path folder = scratch.file("results");
  std::optional<experiment::RunKeyFile> file(std::in_place, folder.string());
  EXPECT_EQ(key_in(folder), file->key().text());
  EXPECT_EQ(fs::status(folder / bridges::run_key_file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  file.reset();
  EXPECT_FALSE(fs::exists(folder / bridges::run_key_file));
  EXPECT_TRUE(fs::exists(folder)) << "the results remain";
}

TEST(RunKeyFile, ReplacesTheKeyOfAnEarlierRun) {
  const test_support::ScratchFolder scratch;
  std::ofstream(scratch.file(bridges::run_key_file)) << "old";
  const experiment::RunKeyFile file(scratch.file("."));
  EXPECT_EQ(key_in(scratch.file(".")), file.key().text());
}

TEST(RunKeyFile, WithoutAFolderItMakesOneForThisRun) {
  std::optional<experiment::RunKeyFile> file(std::in_place, "");
  const fs::path folder = file->folder();
  EXPECT_EQ(key_in(folder), file->key().text());
  EXPECT_EQ(fs::status(folder).permissions(), fs::perms::owner_all);
  file.reset();
  EXPECT_FALSE(fs::exists(folder));
}

}  // namespace
