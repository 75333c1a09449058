// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/run/run_ports.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <memory>
#include <set>
#include <vector>

#include "sim/config/file_access.hpp"
#include "tests/scratch_folder.hpp"

namespace {

namespace fs = std::filesystem;

TEST(RunPorts, ARelativePathIsBelowTheResultsOfItsRun) {
  const test_support::ScratchFolder folder;
  experiment::RunOptions options;
  options.results = folder.file(".");
  options.name = "second";
  const auto port = experiment::serial_ports_of({}, options)(sim::PortKind::fifo, "{run}/gps");
  EXPECT_TRUE(fs::exists(folder.file("serial/second/gps.in")));
  EXPECT_TRUE(fs::exists(folder.file("serial/second/gps.out")));
}

TEST(RunPorts, AnAbsolutePathIsInAFolderThatTheCommandLineAllows) {
  const test_support::ScratchFolder folder;
  fs::create_directory(folder.file("dev"));
  sim::WorldConfig world;
  world.files = std::make_shared<sim::FileAccess>(std::vector<std::string>{}, std::vector{folder.file("dev")},
                                                  std::set<std::string>{});
  const sim::PortOpener open = experiment::serial_ports_of(world, {});
  const auto port = open(sim::PortKind::fifo, folder.file("dev/gps"));
  EXPECT_TRUE(fs::exists(folder.file("dev/gps.in")));
  EXPECT_THAT([&] { open(sim::PortKind::fifo, folder.file("gps")); },
              testing::ThrowsMessage<std::runtime_error>(testing::HasSubstr("--allow-path")));
  EXPECT_FALSE(fs::exists(folder.file("gps.in")));
}

}  // namespace
