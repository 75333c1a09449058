// SPDX-License-Identifier: BSD-3-Clause
// No world that comes with Shoal is warned of, neither as it is read nor as it is built, nor after a run without its
// programs.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "experiment/process/process_check.hpp"
#include "experiment/score/first_contacts.hpp"
#include "sim/world/world_checks.hpp"
#include "tests/devices/comms/port_fixture.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"
#include "tests/sim/medium/log_capture.hpp"

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

struct BuiltWorld {
  explicit BuiltWorld(const std::string& name)
      : loaded(sim::load_world(test_support::source_path("worlds/") + name + ".yaml",
                               test::LoadedTestWorld::with_messages({}))),
        world(loaded.config, bus, [](sim::PortKind, const std::string&) -> std::unique_ptr<sim::BytePort> {
          return std::make_unique<test::FakePort>(std::make_shared<test::PortEnd>());
        }) {}
  sim::LoadedWorld loaded;
  sim::InProcessBus bus;
  sim::World world;
};

class ShippedWorld : public testing::TestWithParam<std::string> {};

TEST_P(ShippedWorld, IsNotWarnedOf) {
  const test_support::LogCapture log;
  const BuiltWorld built(GetParam());
  sim::Warnings warnings;
  experiment::warn_of_processes(built.loaded, warnings);
  EXPECT_EQ(log.text(), "");
}

/// After a minute where that takes few steps, from which on sensors without a lock or a fix are named.  Vehicles whose
/// programs are missing here stay where they start.
TEST_P(ShippedWorld, IsNotWarnedOfAtTheEndOfAShortRun) {
  BuiltWorld built(GetParam());
  experiment::FirstContacts contacts(built.world);
  constexpr int few_steps = 50;
  const sim::Time minute = std::chrono::seconds(61);
  const bool is_quick =
      built.world.step_time() >= std::chrono::milliseconds(100) && built.loaded.config.processes.empty();
  const sim::Time end = is_quick ? minute : few_steps * built.world.step_time();
  while (built.world.now() < end) {
    built.world.step();
    contacts.after_step();
  }
  EXPECT_THAT(sim::end_warnings(built.world, [](const std::string&) { return false; }), testing::IsEmpty());
  EXPECT_EQ(experiment::contacts_text(contacts.all()), "");
}

INSTANTIATE_TEST_SUITE_P(Warnings, ShippedWorld, testing::ValuesIn(shipped_worlds()), [](const auto& world) {
  std::string name = world.param;
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
});

}  // namespace
