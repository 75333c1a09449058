// SPDX-License-Identifier: BSD-3-Clause
// Snapshot files with a right checksum and a wrong state: refused, or the world continues.  It never hangs or crashes.
// SHOAL_MUTATIONS: how many of each world, without it some; SHOAL_MUTATION_SEED: another campaign.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "experiment/snapshot/snapshot_file.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/comms/port_fixture.hpp"
#include "tests/devices/state_fixture.hpp"
#include "tests/project_paths.hpp"

namespace {

std::int64_t from_environment(const char* name, std::int64_t otherwise) {
  const char* const text = std::getenv(name);
  return text != nullptr ? std::atoll(text) : otherwise;
}

/// Ends the program with the number of the mutation that takes too long: a hang cannot be reported in another way.
class Watchdog {
 public:
  explicit Watchdog(const std::string& world) : world_(world), thread_([this] { watch(); }) {}
  ~Watchdog() {
    over_ = true;
    thread_.join();
  }
  void begins(std::int64_t mutation) { mutation_ = mutation; }

 private:
  void watch() {
    constexpr std::chrono::seconds timeout{60};
    std::int64_t seen = mutation_;
    auto since = std::chrono::steady_clock::now();
    for (; !over_; std::this_thread::sleep_for(std::chrono::milliseconds(50))) {
      const auto now = std::chrono::steady_clock::now();
      if (mutation_ != seen) seen = mutation_, since = now;
      if (now - since < timeout) continue;
      std::fprintf(stderr, "world '%s': mutation %lld hangs\n", world_.c_str(), static_cast<long long>(seen));
      std::abort();
    }
  }

  std::string world_;
  std::atomic<std::int64_t> mutation_{-1};
  std::atomic<bool> over_{false};
  std::thread thread_;
};

template <typename Number>
void put(sim::Bytes& bytes, std::size_t at, Number number) {
  if (at + sizeof number <= bytes.size()) std::memcpy(bytes.data() + at, &number, sizeof number);
}

/// One to four places: a bit, a number that is hard to take, or a piece of another place.
void mutate(sim::Bytes& bytes, sim::Random& random) {
  const auto size = static_cast<std::uint32_t>(bytes.size());
  constexpr std::int64_t whole[] = {0,
                                    -1,
                                    1,
                                    2,
                                    1'000'000,
                                    std::int64_t{1} << 32,
                                    std::int64_t{1} << 53,
                                    std::numeric_limits<std::int64_t>::max(),
                                    std::numeric_limits<std::int64_t>::min(),
                                    1'000'000'000'000,
                                    -1'000'000'000'000};
  constexpr double real[] = {1e300,
                             -1e300,
                             1e30,
                             -1e30,
                             1e-300,
                             1e12,
                             -1,
                             0,
                             std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()};
  const std::uint32_t places = 1 + random.integer_below(4);
  for (std::uint32_t i = 0; i < places; ++i) {
    const std::size_t at = random.integer_below(size);
    switch (random.integer_below(5)) {
      case 0:
        bytes[at] ^= static_cast<std::byte>(1 << random.integer_below(8));
        break;
      case 1:
        put(bytes, at, whole[random.integer_below(std::size(whole))]);
        break;
      case 2:
        put(bytes, at, real[random.integer_below(std::size(real))]);
        break;
      case 3:
        put(bytes, at, static_cast<std::int32_t>(whole[random.integer_below(std::size(whole))]));
        break;
      default: {
        std::int64_t other = 0;
        std::memcpy(&other, bytes.data() + random.integer_below(size - 8), sizeof other);
        put(bytes, at, other);
      }
    }
  }
}

class SnapshotMutation : public testing::TestWithParam<const char*> {};

TEST_P(SnapshotMutation, NeitherHangsNorCrashes) {
  const std::string path = test_support::source_path("worlds/") + GetParam() + ".yaml";
  const sim::LoadedWorld loaded = sim::load_world(path, test::LoadedTestWorld::with_messages({}));
  sim::InProcessBus bus;
  sim::World world(loaded.config, bus, [](sim::PortKind, const std::string&) -> std::unique_ptr<sim::BytePort> {
    return std::make_unique<test::FakePort>(std::make_shared<test::PortEnd>());
  });
  const auto step = [&](int count) {
    for (int i = 0; i < count; ++i) world.step();
  };
  step(300);
  const sim::Bytes good = world.state().snapshot();
  experiment::Snapshot file;
  file.step_us = world.step_time().count();
  file.step = world.step_number();
  sim::Random random(static_cast<std::uint64_t>(from_environment("SHOAL_MUTATION_SEED", 1)), GetParam());
  Watchdog watchdog(GetParam());
  const std::int64_t count = from_environment("SHOAL_MUTATIONS", 30);
  std::int64_t refused = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    watchdog.begins(i);
    random.begin_step(i);
    file.state = good;
    mutate(file.state, random);
    // As a file: its checksum is that of what was changed.
    const experiment::Snapshot crafted =
        experiment::snapshot_from_bytes(experiment::to_bytes(file), "crafted.snapshot");
    try {
      world.state().restore(crafted.state);
      step(20);
    } catch (const sim::SnapshotError&) {
      ++refused;
    } catch (const sim::PhysicsFault&) {  // a number that is possible, and too large for this world
    }
    ASSERT_NO_THROW(world.state().restore(good)) << i;
  }
  ASSERT_NO_THROW(step(20));
  RecordProperty("refused", static_cast<int>(refused));
  std::printf("%s: %lld mutations, %lld refused\n", GetParam(), static_cast<long long>(count),
              static_cast<long long>(refused));
}

INSTANTIATE_TEST_SUITE_P(ShippedWorlds, SnapshotMutation,
                         testing::Values("minimal", "coop_land", "coop_underwater", "dynamic_warehouse", "otter_sea",
                                         "micromodems", "segway", "survey", "sonar_tank", "clock_bench"),
                         [](const auto& world) { return std::string(world.param); });

}  // namespace
