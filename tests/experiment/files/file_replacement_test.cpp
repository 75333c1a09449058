// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/files/file_replacement.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/scratch_folder.hpp"

namespace {

namespace fs = std::filesystem;

void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

template <typename Work>
std::string error_of(const Work& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

std::size_t files_in(const test_support::ScratchFolder& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder.file("")), {}));
}

TEST(FileReplacement, ReplacesTheContentThatWasRead) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("a.yaml");
  write(path, "old");
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  experiment::replace_file(path, "old", "new");
  EXPECT_EQ(content_of(path), "new");
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(files_in(folder), 1u);
}

TEST(FileReplacement, LeavesAFileThatHasChanged) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("a.yaml");
  write(path, "changed");
  EXPECT_EQ(error_of([&] { experiment::replace_file(path, "old", "new"); }),
            path + ": cannot be written: it has changed since it was read");
  EXPECT_EQ(content_of(path), "changed");
  EXPECT_EQ(files_in(folder), 1u);
}

TEST(FileReplacement, LeavesAFileWithAnotherNameOrWithout) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("a.yaml");
  EXPECT_EQ(error_of([&] { experiment::replace_file(path, "old", "new"); }),
            path + ": cannot be written: it does not exist any more");
  write(path, "old");
  fs::create_hard_link(path, folder.file("b.yaml"));
  EXPECT_EQ(error_of([&] { experiment::replace_file(path, "old", "new"); }),
            path + ": cannot be written: it has more than one hard link");
  EXPECT_EQ(content_of(path), "old");
}

TEST(FileReplacement, KeepsASymbolicLinkAndReplacesItsTarget) {
  const test_support::ScratchFolder folder;
  write(folder.file("target"), "old");
  fs::create_symlink(folder.file("target"), folder.file("link"));
  experiment::replace_file(folder.file("link"), "old", "new");
  EXPECT_TRUE(fs::is_symlink(folder.file("link")));
  EXPECT_EQ(content_of(folder.file("target")), "new");
  experiment::write_whole_file(folder.file("link"), "newer");
  EXPECT_TRUE(fs::is_symlink(folder.file("link")));
  EXPECT_EQ(content_of(folder.file("target")), "newer");
}

TEST(WholeFile, IsWrittenAnewOrInPlaceOfAnother) {
  const test_support::ScratchFolder folder;
  const std::string path = folder.file("a.csv");
  experiment::check_whole_file(path);
  EXPECT_FALSE(fs::exists(path));
  experiment::write_whole_file(path, "one");
  experiment::write_whole_file(path, "two");
  experiment::check_whole_file(path);
  EXPECT_EQ(content_of(path), "two");
  EXPECT_EQ(files_in(folder), 1u);
}

TEST(WholeFile, IsNoFolderNoDeviceAndNoLinkToNothing) {
  const test_support::ScratchFolder folder;
  fs::create_symlink(folder.file("nowhere"), folder.file("link"));
  const auto errors_of = [](const std::string& path) {
    const std::string first = error_of([&] { experiment::write_whole_file(path, "x"); });
    EXPECT_EQ(error_of([&] { experiment::check_whole_file(path); }), first);
    return first;
  };
  EXPECT_EQ(errors_of(folder.file("link")),
            folder.file("link") + ": cannot be written: it is a symbolic link to nothing");
  EXPECT_EQ(errors_of("/dev/null"), "/dev/null: cannot be written: it is not a regular file");
  EXPECT_EQ(errors_of(folder.file("no/folder")),
            folder.file("no/folder") + ": cannot be written: No such file or directory");
}

}  // namespace
