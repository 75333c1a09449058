// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "bridges/lcm/lcm_listener.hpp"
#include "messages/yaml/message_writer.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/world/world.hpp"
#include "sim/world/world_state.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/system/shoal_program.hpp"

// The same world gives the same run: one hash, however it is run and whoever listens.

namespace {

using namespace system_test;

struct Case {
  const char* world;
  const char* duration_s;
  std::vector<std::string> sets = {};  ///< as given with --set, to see all of it in less time

  friend void PrintTo(const Case& self, std::ostream* out) { *out << self.world; }
};

class Determinism : public testing::TestWithParam<Case> {
 protected:
  std::vector<std::string> run_arguments(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"run", source(GetParam().world), "--duration", GetParam().duration_s};
    for (const std::string& set : GetParam().sets) arguments.insert(arguments.end(), {"--set", set});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  std::string hash_of(const std::vector<std::string>& more) const {
    return run_hash_in(run_shoal(run_arguments(more)));
  }
  /// The hash of the run after every step, in this process.  `back_every_steps`: goes back by half of them as often,
  /// each time to a snapshot.
  std::vector<std::uint64_t> hashes_here(int threads = 1, std::size_t back_every_steps = 0) const {
    sim::LoadOptions options;
    options.encode_message = shoal::encode_own_message;
    options.sets = GetParam().sets;
    const auto loaded = sim::load_world(source(GetParam().world), options);
    sim::InProcessBus bus;
    sim::World world(loaded.config, bus);
    world.use_threads(threads);
    std::vector<std::uint64_t> hashes;
    sim::Bytes snapshot;
    std::size_t farthest = 0;
    while (world.now() < sim::from_seconds(std::stod(GetParam().duration_s))) {
      world.step();
      hashes.push_back(world.state().run_hash());
      if (back_every_steps == 0) continue;
      if (hashes.size() % back_every_steps == back_every_steps / 2 && hashes.size() > farthest) {
        snapshot = world.state().snapshot();
      } else if (hashes.size() % back_every_steps == 0 && hashes.size() > farthest) {
        farthest = hashes.size();
        world.state().restore(snapshot);
        hashes.resize(hashes.size() - back_every_steps / 2);
      }
    }
    return hashes;
  }
};

std::string hexadecimal(std::uint64_t value) {
  char text[20];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

TEST_P(Determinism, HoldsForASecondRunInOneProcessAndInAnotherProcess) {
  const auto first = hashes_here();
  EXPECT_EQ(first, hashes_here());
  EXPECT_EQ(hash_of({"--bus", "none", "--speed", "max"}), hexadecimal(first.back()));
}

TEST_P(Determinism, HoldsForAnyNumberOfThreads) {
  const auto expected = hashes_here(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(hashes_here(threads), expected) << threads;
  EXPECT_EQ(hashes_here(1, 150), expected) << "with snapshots";
  EXPECT_EQ(hashes_here(2, 60), expected) << "with snapshots";
}

TEST_P(Determinism, HoldsForAnySpeedBusRecordAndListener) {
  const ScratchFolder folder;
  const std::string expected = hash_of({"--bus", "none", "--speed", "max"});
  EXPECT_EQ(hash_of({"--bus", "none", "--speed", "20"}), expected);
  const std::string url = own_url();
  EXPECT_EQ(hash_of({"--lcm-url", url, "--speed", "max"}), expected);
  EXPECT_EQ(hash_of({"--lcm-url", url, "--speed", "50", "--record", folder.file("run.lcm"), "--results",
                     folder.file("results"), "--no-plots"}),
            expected);
  EXPECT_EQ(summary_value(folder.file("results"), "run_hash"), '"' + expected + '"');
  EXPECT_EQ(hash_of({"--bus", "none", "--speed", "max", "--set", "state_rate_hz=100", "--set", "run.track_rate_hz=1",
                     "--set", "run.hash_every_steps=7", "--record", folder.file("more.lcm"), "--rewind-s", "5"}),
            expected);

  Program spy({built("shoal"), "spy", "--lcm-url", url});
  bridges::LcmListener listener(url);
  listener.listen_to_all();
  EXPECT_EQ(hash_of({"--lcm-url", url, "--speed", "max"}), expected);
  EXPECT_TRUE(listener.next(timeout));  // someone did listen
  spy.send_signal(SIGINT);
  EXPECT_EQ(spy.wait(), 0) << spy.errors();
}

TEST_P(Determinism, HoldsForRecordsByteByByte) {
  const ScratchFolder folder;
  hash_of({"--bus", "none", "--speed", "max", "--threads", "1", "--record", folder.file("a.lcm")});
  hash_of({"--lcm-url", own_url(1), "--speed", "50", "--threads", "8", "--record", folder.file("b.lcm")});
  const std::string record = text_of_file(folder.file("a.lcm"));
  EXPECT_GT(record.size(), 1000u);
  EXPECT_TRUE(record == text_of_file(folder.file("b.lcm")));
}

TEST_P(Determinism, AnotherSeedIsAnotherRun) {
  const auto hash = [&](const char* seed) {
    return state_hash_in(run_shoal(run_arguments({"--bus", "none", "--speed", "max", "--seed", seed})));
  };
  EXPECT_NE(hash("1"), hash("2"));
}

INSTANTIATE_TEST_SUITE_P(Worlds, Determinism,
                         testing::Values(Case{"worlds/minimal.yaml", "20"}, Case{"worlds/erl_room.yaml", "20"},
                                         Case{"worlds/scale.yaml", "2"}, Case{"worlds/dynamic_warehouse.yaml", "20"},
                                         Case{"worlds/office.yaml", "13", {"events.tidy_up.from_s=12"}},
                                         Case{"worlds/proving_ground.yaml", "20"},
                                         Case{"worlds/proving_sea.yaml", "20"}, Case{"worlds/hill_course.yaml", "5"},
                                         Case{"worlds/sonar_tank.yaml", "5"}, Case{"worlds/survey.yaml", "10"},
                                         Case{"worlds/harbour.yaml", "5"}, Case{"worlds/coop_underwater.yaml", "10"},
                                         Case{"worlds/coop_relay.yaml", "10"}, Case{"worlds/clock_bench.yaml", "60"}),
                         [](const auto& test) { return std::filesystem::path(test.param.world).stem().string(); });

TEST(CoopLand, IsTheSameRunAtAnySpeedWithItsProcesses) {
  const ScratchFolder folder;
  std::string hashes[2];
  const char* speeds[] = {"max", "20"};
  for (int i = 0; i < 2; ++i) {
    const Ended ended = run_shoal({"run", source("worlds/coop_land.yaml"), "--launch", "--duration", "20", "--speed",
                                   speeds[i], "--lcm-url", own_url(i), "--record", folder.file(speeds[i])});
    EXPECT_TRUE(ended.exit_code == 0 || ended.exit_code == 1) << ended.errors;  // too short to be judged
    hashes[i] = run_hash_in(ended);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  const std::string record = text_of_file(folder.file("max"));
  EXPECT_GT(record.size(), 100'000u);
  EXPECT_TRUE(record == text_of_file(folder.file("20")));
}

class EveryWorld : public testing::TestWithParam<std::string> {};

TEST_P(EveryWorld, RunsForASecond) {
  const Ended ended = run_shoal(
      {"run", source("worlds/" + GetParam() + ".yaml"), "--duration", "1", "--speed", "max", "--bus", "none"});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_NE(ended.output.find("1.00 s simulated"), std::string::npos) << ended.output;
}

std::vector<std::string> world_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(source("worlds")))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Worlds, EveryWorld, testing::ValuesIn(world_names()),
                         [](const auto& test) { return test.param; });

}  // namespace
