// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/file_access.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

namespace fs = std::filesystem;

class FileAccessTest : public testing::Test {
 protected:
  FileAccessTest() {
    for (const char* name : {"world/meshes", "vehicles", "worldly", "other"})
      fs::create_directories(folder_.file(name));
    for (const char* name : {"world/a.obj", "world/meshes/b.obj", "worldly/c.obj", "other/d.obj"})
      std::ofstream(folder_.file(name)) << "v 0 0 0\n";
  }
  std::string at(const std::string& name) const { return folder_.file(name); }
  sim::FileAccess access(std::vector<std::string> allowed = {}) const {
    return {{at("world"), at("world/../vehicles")}, std::move(allowed), {}};
  }

  test_support::ScratchFolder folder_;
};

TEST_F(FileAccessTest, WhatLiesBelowAFolderMayBeRead) {
  for (const char* name : {"world/a.obj", "world/meshes/b.obj", "world/not/there.obj", "vehicles/x.yaml",
                           "world/../vehicles/x.yaml", "world/meshes/../a.obj", "other/../world/a.obj"})
    EXPECT_TRUE(access().may_read(at(name))) << name;
  for (const char* name : {"worldly/c.obj", "other/d.obj", "world/../other/d.obj", "", "world/../../x"})
    EXPECT_FALSE(access().may_read(at(name))) << name;
  EXPECT_FALSE(access().may_read("/etc/passwd"));
}

TEST_F(FileAccessTest, ALinkCountsByWhatItLeadsTo) {
  fs::create_symlink(at("other/d.obj"), at("world/link.obj"));
  fs::create_directory_symlink(at("other"), at("world/folder"));
  fs::create_symlink(at("world/a.obj"), at("other/back.obj"));
  EXPECT_FALSE(access().may_read(at("world/link.obj")));
  EXPECT_FALSE(access().may_read(at("world/folder/d.obj")));
  EXPECT_FALSE(access().may_read(at("world/folder/../other/d.obj")));
  EXPECT_TRUE(access().may_read(at("other/back.obj")));
}

TEST_F(FileAccessTest, TheCommandLineAllowsFoldersAndFiles) {
  EXPECT_TRUE(access({at("other/")}).may_read(at("other/d.obj")));
  EXPECT_TRUE(access({at("other/d.obj")}).may_read(at("other/d.obj")));
  EXPECT_FALSE(access({at("other/d.obj")}).may_read(at("other/e.obj")));
  EXPECT_TRUE(access({at("other")}).may_quote(at("other/d.obj")));
  EXPECT_FALSE(access({at("other")}).may_quote(at("world/a.obj")));
}

TEST_F(FileAccessTest, APortIsMadeBelowTheRunOrWhereTheCommandLineAllowsIt) {
  EXPECT_TRUE(access().may_make("{vehicle}.modem"));
  EXPECT_TRUE(access().may_make("ports/a.modem"));
  for (const std::string& path : std::vector<std::string>{"../a.modem", "ports/../../a", at("world/a.modem"), "/tmp/x"})
    EXPECT_FALSE(access().may_make(path)) << path;
  EXPECT_TRUE(access({at("other")}).may_make(at("other/deep/{vehicle}.modem")));
  EXPECT_FALSE(access({at("other")}).may_make(at("other/../world/a.modem")));
}

namespace fs = std::filesystem;

void make_shipped(const fs::path& folder) {
  fs::create_directories(folder / "worlds");
  fs::create_directories(folder / "vehicles");
}

TEST(ShippedFiles, OfAnInstallationAreInItsShare) {
  const test_support::ScratchFolder prefix;
  EXPECT_EQ(sim::shipped_folder_of(prefix.file("bin")), "");
  make_shipped(prefix.file("share/shoal"));
  EXPECT_EQ(sim::shipped_folder_of(prefix.file("bin")), prefix.file("share/shoal"));
}

TEST(ShippedFiles, OfABuildAreInTheCheckoutThatItsCacheNames) {
  const test_support::ScratchFolder folder;
  make_shipped(folder.file("checkout"));
  fs::create_directories(folder.file("build/bin"));
  std::ofstream(folder.file("build/CMakeCache.txt"))
      << "# a cache\nCMAKE_HOME_DIRECTORY:INTERNAL=" << folder.file("checkout") << "\n";
  EXPECT_EQ(sim::shipped_folder_of(folder.file("build/bin")), folder.file("checkout"));
}

TEST(ShippedFiles, NeedWorldsAndVehicles) {
  const test_support::ScratchFolder prefix;
  fs::create_directories(prefix.file("share/shoal/worlds"));
  EXPECT_EQ(sim::shipped_folder_of(prefix.file("bin")), "");
}

TEST(ShippedFiles, OfTheTestsAreThoseOfTheProject) {
  EXPECT_TRUE(fs::equivalent(sim::shipped_folder(), test_support::source_path(".")));
  EXPECT_TRUE(fs::is_directory(sim::program_folder()));
}

}  // namespace
