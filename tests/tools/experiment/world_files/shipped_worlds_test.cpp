// SPDX-License-Identifier: BSD-3-Clause
// No world that comes with Shoal is warned of, neither as it is read nor as it is built.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/devices/comms/port_fixture.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"
#include "tests/sim/medium/log_capture.hpp"
#include "tools/experiment/process/process_check.hpp"

namespace {

namespace fs = std::filesystem;

std::vector<std::string> shipped_worlds() {
  std::vector<std::string> names;
  for (const char* folder : {"", "benchmark/"})
    for (const auto& file : fs::directory_iterator(test_support::source_path("worlds/") + folder))
      if (file.path().extension() == ".yaml") names.push_back(folder + file.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

class ShippedWorld : public testing::TestWithParam<std::string> {};

TEST_P(ShippedWorld, IsNotWarnedOf) {
  const test_support::LogCapture log;
  const sim::LoadedWorld loaded = sim::load_world(test_support::source_path("worlds/") + GetParam() + ".yaml",
                                                  test::LoadedTestWorld::with_messages({}));
  sim::Warnings warnings;
  tools::warn_of_processes(loaded, warnings);
  sim::InProcessBus bus;
  const sim::World world(loaded.config, bus, [](sim::PortKind, const std::string&) -> std::unique_ptr<sim::BytePort> {
    return std::make_unique<test::FakePort>(std::make_shared<test::PortEnd>());
  });
  EXPECT_EQ(log.text(), "");
}

INSTANTIATE_TEST_SUITE_P(Warnings, ShippedWorld, testing::ValuesIn(shipped_worlds()), [](const auto& world) {
  std::string name = world.param;
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
});

}  // namespace
