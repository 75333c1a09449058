// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/files/part_file.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "tests/scratch_folder.hpp"

namespace {

namespace fs = std::filesystem;

TEST(PartFile, HasItsNameWhenItIsFinished) {
  const test_support::ScratchFolder scratch;
  const std::string path = scratch.file("a");
  {
    experiment::PartFile<> file(path);
    EXPECT_EQ(write(file.number(), "new", 3), 3);
    EXPECT_FALSE(fs::exists(path));
    file.finish();
  }
  EXPECT_EQ(fs::file_size(path), 3u);
  EXPECT_FALSE(fs::exists(path + ".part"));
}

TEST(PartFile, IsRemovedWhenItIsNotFinished) {
  const test_support::ScratchFolder scratch;
  const std::string path = scratch.file("a");
  std::ofstream(path) << "before";
  { const experiment::PartFile<> file(path); }
  EXPECT_EQ(fs::file_size(path), 6u);
  EXPECT_FALSE(fs::exists(path + ".part"));
}

TEST(PartFile, AnErrorNamesTheFileAndNotThePart) {
  const test_support::ScratchFolder scratch;
  try {
    const experiment::PartFile<> file(scratch.file("missing/a"));
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), scratch.file("missing/a") + ": cannot be written: No such file or directory");
  }
}

TEST(PartFile, AFolderOfItsNameIsAnErrorOfTheEnd) {
  const test_support::ScratchFolder scratch;
  fs::create_directory(scratch.file("a"));
  {
    experiment::PartFile<> file(scratch.file("a"));
    EXPECT_THROW(file.finish(), std::runtime_error);
  }
  EXPECT_FALSE(fs::exists(scratch.file("a.part")));
}

}  // namespace
