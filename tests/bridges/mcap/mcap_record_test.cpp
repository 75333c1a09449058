// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/mcap/mcap_record.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "bridges/mcap/mcap_reader.hpp"
#include "bridges/ros2/cdr.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/sim_info_t.hpp"
#include "shoal/utime_t.hpp"
#include "tests/bridges/lcm/lcm_test_support.hpp"

namespace {

using namespace bridges::mcap;
using lcm_test::bytes_of;
using lcm_test::ScratchFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using testing::UnorderedElementsAre;

bridges::FileDescriptor record_at(const std::string& path) {
  return bridges::FileDescriptor(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
}

/// Type and count of messages of each topic.
std::map<std::string, std::pair<std::string, int>> topics_of(const std::string& path) {
  McapReader reader(path);
  std::map<std::string, std::pair<std::string, int>> topics;
  for (McapReader::Item item; (item = reader.next()) != McapReader::Item::end;) {
    if (item != McapReader::Item::message) continue;
    const Channel& channel = reader.channel(reader.message().channel);
    auto& [type, count] = topics[channel.topic];
    type = channel.schema == 0 ? channel.encoding : reader.schemas().at(channel.schema).name;
    ++count;
  }
  EXPECT_TRUE(reader.complete());
  EXPECT_THAT(reader.problems(), ElementsAre());
  return topics;
}

shoal::sim_info_t info_of_branch(std::int32_t branch) {
  shoal::sim_info_t info{};
  info.world = "test";
  info.seed = 42;
  info.branch = branch;
  info.resolved_config = "name: test\n";
  return info;
}

TEST(McapRecord, EachChannelHasItsTopicAndAStandardOne) {
  const ScratchFolder folder;
  McapRecord record(record_at(folder.file("a.mcap")));
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(record.write(i, "rover1.gps", shoal::encode(shoal::gps_data_t{})));
    EXPECT_TRUE(record.write(i, "sim.clock", shoal::encode(shoal::utime_t{i})));
  }
  EXPECT_TRUE(record.finish());
  EXPECT_THAT(topics_of(folder.file("a.mcap")),
              UnorderedElementsAre(Pair("/rover1/gps", Pair("shoal_interfaces/msg/GpsData", 3)),
                                   Pair("/rover1/gps/fix", Pair("sensor_msgs/msg/NavSatFix", 3)),
                                   Pair("/sim/clock", Pair("shoal_interfaces/msg/Utime", 3)),
                                   Pair("/clock", Pair("rosgraph_msgs/msg/Clock", 3))));
}

TEST(McapRecord, TimesAreInNanosecondsOfSimulatedTime) {
  const ScratchFolder folder;
  McapRecord record(record_at(folder.file("a.mcap")));
  EXPECT_TRUE(record.write(1'767'225'600'000'001, "sim.clock", shoal::encode(shoal::utime_t{5})));
  EXPECT_TRUE(record.finish());
  McapReader reader(folder.file("a.mcap"));
  ASSERT_EQ(reader.next(), McapReader::Item::message);
  EXPECT_EQ(reader.message().log_time_ns, 1'767'225'600'000'001'000u);
  EXPECT_EQ(reader.message().publish_time_ns, reader.message().log_time_ns);
}

TEST(McapRecord, KeepsMessagesThatItCannotDecode) {
  const ScratchFolder folder;
  McapRecord record(record_at(folder.file("a.mcap")));
  sim::Bytes broken = shoal::encode(shoal::gps_data_t{});
  broken.pop_back();
  EXPECT_TRUE(record.write(0, "a", bytes_of("unknown type")));
  EXPECT_TRUE(record.write(1, "a", broken));
  EXPECT_TRUE(record.write(2, "a", shoal::encode(shoal::gps_data_t{})));
  EXPECT_TRUE(record.finish());
  EXPECT_EQ(record.not_decoded(), 2u);
  EXPECT_THAT(record.problems(), ElementsAre(HasSubstr("recorded as bytes on /a/bytes"), HasSubstr("too short")));
  const auto topics = topics_of(folder.file("a.mcap"));
  EXPECT_THAT(topics.at("/a/bytes"), Pair("lcm", 2));
  EXPECT_THAT(topics.at("/a"), Pair("shoal_interfaces/msg/GpsData", 1));
}

TEST(McapRecord, NoTwoChannelsHaveOneTopic) {
  const ScratchFolder folder;
  McapRecord record(record_at(folder.file("a.mcap")));
  for (const char* channel : {"a.b", "a/b", "a.b"})
    EXPECT_TRUE(record.write(0, channel, shoal::encode(shoal::utime_t{})));
  EXPECT_TRUE(record.write(0, "a.b", shoal::encode(shoal::gps_data_t{})));  // another type
  EXPECT_TRUE(record.finish());
  const auto topics = topics_of(folder.file("a.mcap"));
  EXPECT_EQ(topics.at("/a/b").second, 2);
  EXPECT_EQ(topics.at("/a/b_2").second, 1);
  EXPECT_EQ(topics.at("/a/b_3").first, "shoal_interfaces/msg/GpsData");
}

TEST(McapRecord, AttachesTheWorldOnceAndDescribesEachBranch) {
  const ScratchFolder folder;
  McapRecord record(record_at(folder.file("a.mcap")));
  for (const std::int32_t branch : {0, 0, 1})
    EXPECT_TRUE(record.write(0, "sim.info", shoal::encode(info_of_branch(branch))));
  EXPECT_TRUE(record.finish());
  McapReader reader(folder.file("a.mcap"));
  std::vector<std::string> found;
  for (McapReader::Item item; (item = reader.next()) != McapReader::Item::end;) {
    if (item == McapReader::Item::attachment)
      found.push_back(reader.attachment().name + ": " + reader.attachment().data);
    if (item == McapReader::Item::metadata)
      found.push_back(reader.metadata().entries.at("seed") + " " + reader.metadata().entries.at("branch"));
  }
  EXPECT_THAT(found, ElementsAre("world.yaml: name: test\n", "42 0", "42 1"));
}

TEST(McapRecord, ABranchStartsWithACopy) {
  const ScratchFolder folder;
  McapRecord record(record_at(folder.file("a.mcap")));
  EXPECT_TRUE(record.write(0, "sim.info", shoal::encode(info_of_branch(0))));
  EXPECT_TRUE(record.write(1, "x.gps", shoal::encode(shoal::gps_data_t{})));
  const std::uint64_t mark = record.file().messages();
  EXPECT_TRUE(record.write(2, "x.gps", shoal::encode(shoal::gps_data_t{})));
  const auto branch = record.branch(folder.file("a.mcap"), mark, record_at(folder.file("b.mcap")));
  ASSERT_NE(branch, nullptr);
  EXPECT_TRUE(branch->write(3, "sim.info", shoal::encode(info_of_branch(1))));
  EXPECT_TRUE(branch->write(3, "x.gps", shoal::encode(shoal::gps_data_t{})));
  EXPECT_TRUE(branch->write(3, "y.gps", shoal::encode(shoal::gps_data_t{})));
  EXPECT_TRUE(branch->finish());
  EXPECT_TRUE(record.finish());
  EXPECT_EQ(topics_of(folder.file("a.mcap")).at("/x/gps").second, 2);
  const auto topics = topics_of(folder.file("b.mcap"));
  EXPECT_EQ(topics.at("/x/gps").second, 2);
  EXPECT_EQ(topics.at("/y/gps/fix").second, 1);
  EXPECT_EQ(record.branch(folder.file("a.mcap"), 1000, record_at(folder.file("c.mcap"))), nullptr);
}

// tools/test_mcap reads this file with the reference libraries.
TEST(McapRecord, HasTheMessagesOfAllTypes) {
  const ScratchFolder folder;
  const char* kept = std::getenv("SHOAL_TEST_MCAP");
  const std::string path = kept != nullptr ? kept : folder.file("all.mcap");
  constexpr int messages_of_each = 20;
  McapRecord record(record_at(path));
  lcm_test::PayloadBuilder builder(5);
  std::map<std::string, std::vector<std::byte>> expected;
  for (const auto& [name, schema] : shoal::embedded_types().all())
    for (int i = 0; i < messages_of_each; ++i) {
      const sim::Bytes payload = builder.build(schema);
      EXPECT_TRUE(record.write(i, name, payload));
      if (i > 0) continue;
      EXPECT_EQ(bridges::ros2::to_cdr(schema, payload, expected[name]), std::nullopt);
    }
  EXPECT_TRUE(record.finish());
  EXPECT_EQ(record.not_decoded(), 0u);
  // Compare the first message of each.
  McapReader reader(path);
  for (McapReader::Item item; (item = reader.next()) != McapReader::Item::end;) {
    if (item != McapReader::Item::message || reader.message().sequence > 0) continue;
    const TextMap& metadata = reader.channel(reader.message().channel).metadata;
    if (!metadata.contains("lcm_type")) continue;
    const auto& cdr = expected.at(metadata.at("lcm_channel"));
    EXPECT_TRUE(std::ranges::equal(reader.message().data, cdr)) << metadata.at("lcm_channel");
    expected.erase(metadata.at("lcm_channel"));
  }
  EXPECT_TRUE(expected.empty());
}

}  // namespace
