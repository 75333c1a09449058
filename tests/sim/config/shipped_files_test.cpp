// SPDX-License-Identifier: BSD-3-Clause
#include "sim/config/shipped_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

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
