// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/project_paths.hpp"
#include "tools/experiment/upgrade/upgrade_file.hpp"

namespace {

TEST(UpgradeFile, ShippedFilesAreUpToDate) {
  std::vector<std::string> paths;
  for (const char* folder : {"worlds", "worlds/studies", "vehicles", "examples/plugin", "tests/golden"})
    for (const auto& entry : std::filesystem::directory_iterator(test_support::source_path(folder)))
      if (entry.path().extension() == ".yaml") paths.push_back(entry.path().string());
  EXPECT_GE(paths.size(), 60u);
  for (const tools::FileUpgrade& file : tools::plan_upgrade(paths)) {
    SCOPED_TRACE(file.path);
    EXPECT_THAT(file.errors, testing::IsEmpty());
    EXPECT_EQ(file.state, tools::FileUpgrade::State::up_to_date);
  }
}

}  // namespace
