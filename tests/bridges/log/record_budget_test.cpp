// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>

#include "bridges/log/event_log.hpp"
#include "bridges/log/recording_bus.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace bridges {
namespace {

using lcm_test::bytes_of;
using lcm_test::ScratchFolder;

constexpr std::int64_t record_epoch = 1'700'000'000'000'000;

/// Ten messages a second on a channel of 1000 bytes and one of `sim.inputs`, for ten minutes: about 6.3 MB.
void run_within(const std::string& path, std::uint64_t budget_bytes) {
  sim::InProcessBus network;
  RecordingBus bus(network, path, record_epoch);
  bus.set_budget({budget_bytes, 600'000'000});
  for (std::int64_t i = 0; i < 6000; ++i) {
    const sim::Time at(i * 100'000);
    bus.publish("rover1.lidar", bytes_of(std::string(1000, 'x')), at);
    if (i % 10 == 0) bus.publish("sim.inputs", bytes_of("inputs"), at);
    if (i % 3000 == 0) bus.publish("rover1.map", bytes_of("map"), at);
  }
}

/// Seconds of the events of each channel.
std::map<std::string, std::vector<std::int64_t>> seconds_in(const std::string& path) {
  std::map<std::string, std::vector<std::int64_t>> seconds;
  EventLogReader reader(path);
  while (const auto event = reader.next()) seconds[event->channel].push_back((event->utime - record_epoch) / 1'000'000);
  return seconds;
}

TEST(RecordBudget, IsKeptAndSpreadOverTheRun) {
  const ScratchFolder folder;
  const std::string path = folder.file("run.lcm");
  constexpr std::uint64_t budget = 2'000'000;
  run_within(path, budget);
  EXPECT_LE(std::filesystem::file_size(path), budget);
  EXPECT_GT(std::filesystem::file_size(path), 0.9 * budget);
  auto seconds = seconds_in(path);
  // What a replay needs is whole, and what is rare as well.
  EXPECT_EQ(seconds["sim.inputs"].size(), 600u);
  EXPECT_EQ(seconds["rover1.map"].size(), 2u);
  EXPECT_EQ(seconds[budget_channel].size(), 1u);
  // Each minute has scans: 196 kB, of which 3 kB are inputs, are some 185 of 1.04 kB, in whole seconds of ten; the
  // first minute has 40 kB more.
  std::map<std::int64_t, int> by_minute;
  for (const std::int64_t second : seconds["rover1.lidar"]) ++by_minute[second / 60];
  ASSERT_EQ(by_minute.size(), 10u);
  for (const auto& [minute, scans] : by_minute) {
    EXPECT_GE(scans, 160) << minute;
    EXPECT_LE(scans, 240) << minute;
  }
}

TEST(RecordBudget, OfMoreThanTheRecordLeavesNothingOut) {
  const ScratchFolder folder;
  const std::string path = folder.file("run.lcm");
  run_within(path, 100'000'000);
  EXPECT_EQ(seconds_in(path)["rover1.lidar"].size(), 6000u);
}

TEST(RecordBudget, TooSmallForTheInputsEndsTheRecord) {
  const ScratchFolder folder;
  const std::string path = folder.file("run.lcm");
  run_within(path, 10'000);
  EXPECT_LE(std::filesystem::file_size(path), 10'000u);
  EXPECT_LT(seconds_in(path)["sim.inputs"].size(), 600u);
}

}  // namespace
}  // namespace bridges
