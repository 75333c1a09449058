// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/files/no_links.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "tests/scratch_folder.hpp"

namespace {

namespace fs = std::filesystem;

/// Folder `real` with a link `named` to it, as a user may have one.
struct LinkedFolder {
  LinkedFolder() {
    fs::create_directories(scratch.file("real/below"));
    fs::create_directory_symlink(scratch.file("real"), scratch.file("named"));
  }
  std::string root() const { return scratch.file("named"); }
  std::string below(const std::string& path) const { return root() + "/" + path; }
  test_support::ScratchFolder scratch;
};

TEST(NoLinks, TheFolderItselfMayBeALink) {
  const LinkedFolder folder;
  EXPECT_NO_THROW(experiment::refuse_links(folder.root(), folder.below("below/file")));
  experiment::make_folders(folder.root(), folder.below("a/b"));
  EXPECT_TRUE(fs::is_directory(folder.scratch.file("real/a/b")));
}

TEST(NoLinks, ALinkBelowIsAnErrorWithItsName) {
  const LinkedFolder folder;
  fs::create_directories(folder.scratch.file("victim"));
  fs::create_directory_symlink(folder.scratch.file("victim"), folder.below("below/link"));
  fs::create_symlink(folder.scratch.file("nothing"), folder.below("dangling"));
  for (const char* path : {"below/link", "below/link/file"}) {
    try {
      experiment::refuse_links(folder.root(), folder.below(path));
      ADD_FAILURE() << path;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("/below/link: is a symbolic link"));
    }
  }
  EXPECT_THROW(experiment::refuse_links(folder.root(), folder.below("dangling")), std::runtime_error);
  EXPECT_THROW(experiment::make_folders(folder.root(), folder.below("below/link/new")), std::runtime_error);
  EXPECT_TRUE(fs::is_empty(folder.scratch.file("victim")));
}

TEST(NoLinks, ANewFileTakesThePlaceOfALinkAndLeavesItsTarget) {
  const test_support::ScratchFolder scratch;
  const std::string victim = scratch.file("victim"), path = scratch.file("a.part");
  std::ofstream(victim) << "keep";
  fs::create_symlink(victim, path);
  {
    const bridges::FileDescriptor file = experiment::make_new_file(path);
    EXPECT_EQ(write(file.number(), "new", 3), 3);
  }
  EXPECT_FALSE(fs::is_symlink(path));
  EXPECT_EQ(fs::file_size(path), 3u);
  EXPECT_EQ(fs::file_size(victim), 4u);
  { const bridges::FileDescriptor again = experiment::make_new_file(path); }
  EXPECT_EQ(fs::file_size(path), 0u);
  fs::create_directory(scratch.file("folder"));
  EXPECT_THROW(experiment::make_new_file(scratch.file("folder")), std::system_error);
  EXPECT_THROW(experiment::make_new_file(scratch.file("missing/a.part")), std::system_error);
}

}  // namespace
