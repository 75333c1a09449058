// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "bridges/mcap/mcap_reader.hpp"
#include "experiment/replay/replay_log.hpp"
#include "tests/experiment/replay/recorded_run.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using bridges::mcap::McapReader;
using test_support::ScratchFolder;

constexpr const char* falling_box =
    "shoal: 1\nname: box\nobjects:\n- name: ground\n  fixed: true\n  parts: [{shape: plane}]\nvehicles:\n- name: a\n"
    "  position_m: [0, 0, 2]\n  model:\n    shoal: 1\n    vehicle: box\n    bodies:\n    - name: hull\n"
    "      parts: [{shape: box, size_m: [1, 1, 1], mass_kg: 1}]\n    devices:\n    - {name: imu, type: imu, rate_hz: "
    "50}\n";

/// Runs for 2 s and returns the hash of the run.
std::uint64_t record_box(const std::string& path) {
  test::RecordedRun run(falling_box, path);
  run.run(200);
  EXPECT_EQ(run.recorder.error(), std::nullopt);
  return run.world.state().hash();
}

std::string all_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(McapOfARun, EqualRunsGiveEqualBytes) {
  const ScratchFolder folder;
  const std::uint64_t hash = record_box(folder.file("a.mcap"));
  EXPECT_EQ(record_box(folder.file("b.mcap")), hash);
  EXPECT_TRUE(all_bytes(folder.file("a.mcap")) == all_bytes(folder.file("b.mcap")));
}

TEST(McapOfARun, HasTheMessagesOfTheLog) {
  const ScratchFolder folder;
  EXPECT_EQ(record_box(folder.file("a.mcap")), record_box(folder.file("a.lcm")));
  std::vector<std::string> logged, recorded;
  bridges::EventLogReader log(folder.file("a.lcm"));
  while (const auto event = log.next()) logged.push_back(std::to_string(event->utime) + " " + event->channel);
  McapReader reader(folder.file("a.mcap"));
  for (McapReader::Item item; (item = reader.next()) != McapReader::Item::end;) {
    if (item != McapReader::Item::message) continue;
    const bridges::mcap::Channel& channel = reader.channel(reader.message().channel);
    if (channel.metadata.contains("lcm_type"))
      recorded.push_back(std::to_string(reader.message().log_time_ns / 1000) + " " +
                         channel.metadata.at("lcm_channel"));
  }
  EXPECT_TRUE(reader.complete());
  EXPECT_GT(logged.size(), 100u);  // 50 Hz for 2 s
  EXPECT_EQ(recorded, logged);
}

TEST(McapOfARun, IsNotALogToReplay) {
  const ScratchFolder folder;
  record_box(folder.file("a.mcap"));
  EXPECT_THAT([&] { experiment::read_replay_log(folder.file("a.mcap")); },
              testing::ThrowsMessage<bridges::BusError>(testing::HasSubstr("record with --record NAME.lcm")));
}

}  // namespace
