// SPDX-License-Identifier: BSD-3-Clause
// Every world that comes with the simulator is saved at its start and at random steps, and continues alike wherever it
// is restored.
#include <algorithm>
#include <filesystem>

#include "sim/world/world_editor.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/comms/port_fixture.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"

namespace {

namespace fs = std::filesystem;

/// Hashes all that is published.
class HashingBus final : public sim::Bus {
 public:
  void publish(std::string_view channel, std::span<const std::byte> payload, sim::Time at) override {
    hash_.add(channel);
    hash_.add_bytes(payload.data(), payload.size());
    bus_.publish(channel, payload, at);
  }
  std::unique_ptr<sim::Mailbox> open_mailbox(const std::string& channel, std::size_t capacity) override {
    return bus_.open_mailbox(channel, capacity);
  }
  sim::BusCounts counts() const override { return bus_.counts(); }
  /// Of the messages since the last call.
  std::uint64_t take_hash() { return std::exchange(hash_, {}).value(); }

 private:
  sim::InProcessBus bus_;
  sim::StateHash hash_;
};

/// What a step came to.
struct StepResult {
  std::uint64_t run, messages;
  bool operator==(const StepResult&) const = default;
};

struct SteppedWorld {
  explicit SteppedWorld(const sim::LoadedWorld& loaded)
      : world(loaded.config, bus, [](sim::PortKind, const std::string&) -> std::unique_ptr<sim::BytePort> {
          return std::make_unique<test::FakePort>(std::make_shared<test::PortEnd>());
        }) {}
  StepResult step() {
    world.step();
    return {world.state().run_hash(), bus.take_hash()};
  }
  HashingBus bus;
  sim::World world;
};

std::vector<std::string> worlds() {
  std::vector<std::string> names;
  for (const auto& file : fs::directory_iterator(test_support::source_path("worlds"))) {
    if (file.path().extension() != ".yaml") continue;
    names.push_back(file.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class EveryWorld : public testing::TestWithParam<std::string> {
 protected:
  static constexpr int more_steps = 300;

  EveryWorld() {
    sim::LoadOptions options;
    options.encode_message = shoal::encode_own_message;
    loaded = sim::load_world(test_support::source_path("worlds/") + GetParam() + ".yaml", options);
    sim::Random random(1, GetParam());
    random.begin_step(0);
    saved_at.push_back(0);
    for (int i = 0; i < 3; ++i) saved_at.push_back(static_cast<int>(random.integer_below(1500)));
    std::sort(saved_at.begin(), saved_at.end());
  }

  /// Sets a value of the first device of the world, as an event's `set` does; false: it has none.
  static bool change_a_device(sim::World& world) {
    for (const auto& device : world.devices()) {
      if (!device || !device->senses()) continue;
      sim::Diagnostics diagnostics;
      EXPECT_TRUE(world.editor().change_device(
          device->full_name(), sim::parse_config_text("{latency_s: 0.013, rate_hz: 7}", "set", diagnostics),
          diagnostics))
          << diagnostics.lines().front();
      return true;
    }
    return false;
  }

  /// Restored, it is the world that was saved, and continues like it.
  void expect_goes_on(SteppedWorld& test, std::size_t number) {
    const auto at = static_cast<std::size_t>(saved_at[number]);
    test.world.state().restore(snapshots[number]);
    ASSERT_TRUE(test.world.state().snapshot() == snapshots[number]) << "saved again it is not the same";
    test.bus.take_hash();
    for (std::size_t step = at; step < at + more_steps; ++step) {
      const StepResult result = test.step();
      ASSERT_EQ(result.run, results[step].run) << "in the run hash after step " << step;
      ASSERT_EQ(result.messages, results[step].messages) << "in the messages of step " << step;
    }
  }

  sim::LoadedWorld loaded;
  std::vector<int> saved_at;
  std::vector<sim::Bytes> snapshots;
  std::vector<StepResult> results;
};

TEST_P(EveryWorld, ContinuesFromASnapshotBitForBit) {
  SteppedWorld original(loaded);
  for (int step = 0; step < saved_at.back() + more_steps; ++step) {
    for (const int at : saved_at)
      if (step == at) snapshots.push_back(original.world.state().snapshot());
    results.push_back(original.step());
  }
  for (std::size_t i = 0; i < snapshots.size(); ++i) {
    SteppedWorld fresh(loaded);
    SCOPED_TRACE("saved after " + std::to_string(saved_at[i]) + " steps");
    {
      SCOPED_TRACE("restored in a fresh world");
      if (i == 1) fresh.world.use_threads(3);
      ASSERT_NO_FATAL_FAILURE(expect_goes_on(fresh, i));
    }
    SCOPED_TRACE("restored in the world that continued");
    ASSERT_NO_FATAL_FAILURE(expect_goes_on(original, i));
  }
}

/// To before a value was set, and to after it: both times the world is built again.
TEST_P(EveryWorld, ContinuesFromBeforeAndAfterAValueWasSet) {
  SteppedWorld original(loaded);
  saved_at = {20, 60};
  const int set_at = 40;
  for (int step = 0; step < saved_at.back() + more_steps; ++step) {
    if (step == saved_at[0] || step == saved_at[1]) snapshots.push_back(original.world.state().snapshot());
    if (step == set_at && !change_a_device(original.world)) GTEST_SKIP() << "it has no sensor";
    results.push_back(original.step());
  }
  for (const std::size_t i : {0u, 1u, 0u}) {
    SCOPED_TRACE("saved after " + std::to_string(saved_at[i]) + " steps");
    const auto at = static_cast<std::size_t>(saved_at[i]);
    original.world.state().restore(snapshots[i]);
    ASSERT_TRUE(original.world.state().snapshot() == snapshots[i]) << "saved again it is not the same";
    original.bus.take_hash();
    for (std::size_t step = at; step < at + more_steps / 3; ++step) {
      if (step == set_at) change_a_device(original.world);
      ASSERT_TRUE(original.step() == results[step]) << "after step " << step;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Snapshot, EveryWorld, testing::ValuesIn(worlds()),
                         [](const auto& world) { return world.param; });

}  // namespace
