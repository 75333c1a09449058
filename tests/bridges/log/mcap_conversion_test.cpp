// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/log/mcap_conversion.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "bridges/log/event_log.hpp"
#include "bridges/log/recording_bus.hpp"
#include "bridges/mcap/mcap_reader.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/sim_scene_t.hpp"
#include "shoal/utime_t.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"
#include "tests/bridges/log/mcap_conversion_fixture.hpp"

namespace {

using namespace mcap_conversion_fixture;

using lcm_test::bytes_of;
using lcm_test::ScratchFolder;
using testing::HasSubstr;
using testing::ThrowsMessage;

void record_clocks(const std::string& path, int count) {
  sim::InProcessBus network;
  bridges::RecordingBus bus(network, path, 1'000'000);
  for (int i = 0; i < count; ++i) {
    bus.publish(i % 2 == 0 ? "sim.clock" : "other", shoal::encode(shoal::utime_t{i}), sim::Time(i * 10'000));
    bus.end_of_step();
  }
  bus.publish("odd", bytes_of("no message"), sim::Time(count * 10'000));
  bus.close();
  EXPECT_EQ(bus.error(), std::nullopt);
}

std::string file_content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(McapConversion, GivesTheBytesOfADirectRecord) {
  const ScratchFolder folder;
  record_clocks(folder.file("a.lcm"), 3000);
  record_clocks(folder.file("direct.mcap"), 3000);
  const auto converted =
      bridges::convert_to_mcap({folder.file("a.lcm"), folder.file("a.mcap"), {}, {}, {}}, shoal::embedded_types());
  EXPECT_EQ(converted.events, 3001u);
  EXPECT_EQ(converted.messages, 3001u + 1500u);  // with /clock
  EXPECT_EQ(converted.not_decoded, 1u);
  EXPECT_EQ(converted.bytes, std::filesystem::file_size(folder.file("a.mcap")));
  EXPECT_EQ(count_messages(folder.file("a.mcap")), converted.messages);
  EXPECT_TRUE(file_content(folder.file("a.mcap")) == file_content(folder.file("direct.mcap")));
}

TEST(McapConversion, TakesOnlyTheWantedChannels) {
  const ScratchFolder folder;
  record_clocks(folder.file("a.lcm"), 10);
  std::uint64_t last = 0;
  const auto converted = bridges::convert_to_mcap({folder.file("a.lcm"),
                                                   folder.file("a.mcap"),
                                                   {},
                                                   [](std::string_view channel) { return channel == "other"; },
                                                   [&](std::uint64_t done, std::uint64_t total) {
                                                     EXPECT_LT(done, total);
                                                     last = done;
                                                   }},
                                                  shoal::embedded_types());
  EXPECT_EQ(converted.events, 5u);
  EXPECT_EQ(converted.channels, 1u);
  EXPECT_GT(last, 0u);
}

TEST(McapConversion, KnowsTheDevicesAlsoWhenTheirSceneIsNotWanted) {
  const ScratchFolder folder;
  {
    bridges::EventLogWriter log(bridges::create_record_file(folder.file("a.lcm"), bridges::Existing::refuse));
    shoal::sim_scene_t scene{};
    scene.scene = R"({"vehicles": [{"name": "a", "devices": [{"name": "lidar", "channels": ["a.lidar"],
                      "field_of_view": {"kind": "fan", "range_m": 10, "range_min_m": 0.5}}]}]})";
    log.write(0, 0, "sim.scene", shoal::encode(scene));
    log.write(1, 0, "a.lidar", shoal::encode(shoal::planar_lidar_t{0, 1, {10}, 0, {}, 0, 0}));
    log.flush();
  }
  bridges::convert_to_mcap({folder.file("a.lcm"),
                            folder.file("a.mcap"),
                            {},
                            [](std::string_view channel) { return channel == "a.lidar"; },
                            {}},
                           shoal::embedded_types());
  bridges::mcap::McapReader reader(folder.file("a.mcap"));
  std::vector<std::string> topics;
  std::vector<std::byte> scan;
  for (bridges::mcap::McapReader::Item item; (item = reader.next()) != bridges::mcap::McapReader::Item::end;) {
    if (item != bridges::mcap::McapReader::Item::message) continue;
    topics.push_back(reader.channel(reader.message().channel).topic);
    scan.assign(reader.message().data.begin(), reader.message().data.end());
  }
  ASSERT_EQ(topics, (std::vector<std::string>{"/a/lidar", "/a/lidar/scan"}));
  // Its last numbers: limits, count and value of the ranges, count of the intensities.
  float min_m = 0, max_m = 0, range_m = 0;
  ASSERT_GT(scan.size(), 20u);
  std::memcpy(&min_m, &scan[scan.size() - 20], 4);
  std::memcpy(&max_m, &scan[scan.size() - 16], 4);
  std::memcpy(&range_m, &scan[scan.size() - 8], 4);
  EXPECT_EQ(min_m, 0.5f);
  EXPECT_EQ(max_m, 10.0f);
  EXPECT_EQ(range_m, std::numeric_limits<float>::infinity());
}

TEST(McapConversion, RefusesAnExistingFileAndAnMcapFileAsLog) {
  const ScratchFolder folder;
  record_clocks(folder.file("a.lcm"), 10);
  record_clocks(folder.file("b.mcap"), 10);
  const auto convert = [&](const std::string& log, const std::string& out) {
    bridges::convert_to_mcap({folder.file(log), folder.file(out), {}, {}, {}}, shoal::embedded_types());
  };
  EXPECT_THAT([&] { convert("a.lcm", "b.mcap"); }, ThrowsMessage<bridges::BusError>(HasSubstr("already exists")));
  EXPECT_THAT([&] { convert("b.mcap", "c.mcap"); }, ThrowsMessage<bridges::BusError>(HasSubstr("is an MCAP file")));
}

void record_at(const std::string& path, const std::vector<std::int64_t>& utimes) {
  bridges::EventLogWriter log(bridges::create_record_file(path, bridges::Existing::refuse));
  std::int64_t number = 0;
  for (const std::int64_t utime : utimes) log.write(number++, utime, "sim.clock", shoal::encode(shoal::utime_t{utime}));
  log.flush();
}

constexpr std::int64_t us_per_s = 1'000'000;

TEST(McapConversion, RefusesTimesThatRos2CannotHold) {
  const ScratchFolder folder;
  const std::string range =
      " is outside of 1970-01-01T00:00:00Z to 2038-01-19T03:14:07Z, which messages of ROS 2 in an MCAP file can hold";
  // Midnights in UTC, in seconds of 1970.
  for (const auto& each : {std::pair{"2040-01-01T00:00:00Z", 2'208'988'800 * us_per_s},
                           {"1969-01-01T00:00:00Z", -31'536'000 * us_per_s},
                           {"9999-01-01T00:00:00Z", 253'370'764'800 * us_per_s},
                           {"2038-01-19T03:14:08Z", 2'147'483'648 * us_per_s},
                           {"1969-12-31T23:59:59Z", std::int64_t{-1}}}) {
    const std::string utc = each.first;
    const std::int64_t utime = each.second;
    record_at(folder.file(utc), {1, utime});
    EXPECT_THAT(
        [&] {
          bridges::convert_to_mcap({folder.file(utc), folder.file("a.mcap"), {}, {}, {}}, shoal::embedded_types());
        },
        ThrowsMessage<bridges::BusError>(folder.file(utc) + ": byte 53: the time " + utc + range));
    EXPECT_FALSE(std::filesystem::exists(folder.file("a.mcap")));
    if (utc == "2040-01-01T00:00:00Z") {
      sim::InProcessBus network;
      EXPECT_THAT(
          [&] { bridges::RecordingBus(network, folder.file("b.mcap"), utime); },
          ThrowsMessage<bridges::BusError>(folder.file("b.mcap") +
                                           ": the 'epoch' of the world cannot be recorded: the time " + utc + range));
      EXPECT_FALSE(std::filesystem::exists(folder.file("b.mcap")));
    }
  }
  // A run that comes to the end of that time stops to record with the reason.
  sim::InProcessBus network;
  bridges::RecordingBus bus(network, folder.file("c.mcap"), 2'147'483'647 * us_per_s);
  bus.publish("sim.clock", shoal::encode(shoal::utime_t{0}), sim::Time(0));
  EXPECT_EQ(bus.error(), std::nullopt);
  bus.publish("sim.clock", shoal::encode(shoal::utime_t{0}), sim::Time(us_per_s));
  EXPECT_EQ(bus.error(), folder.file("c.mcap") + ": cannot record: Value too large for defined data type");
}

TEST(McapConversion, ReportsTimeThatGoesBack) {
  const ScratchFolder folder;
  record_at(folder.file("a.lcm"), {2'000'000, 3'000'000, 1'500'000});
  const auto converted =
      bridges::convert_to_mcap({folder.file("a.lcm"), folder.file("a.mcap"), {}, {}, {}}, shoal::embedded_types());
  EXPECT_EQ(converted.events, 3u);
  EXPECT_THAT(converted.time_problem, testing::Optional(HasSubstr("time goes back by 1.5 s at event 3")));
}

}  // namespace
