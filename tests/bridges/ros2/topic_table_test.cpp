// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/topic_table.hpp"

#include <gmock/gmock.h>

#include "shoal/gps_data_t.hpp"
#include "shoal/image_t.hpp"
#include "shoal/message_codec.hpp"

namespace {

using namespace bridges::ros2;
using testing::ElementsAre;
using testing::IsEmpty;

/// Takes the topics that it wants.
class Sink final : public TopicSink {
 public:
  bool wants(const Topic& topic) override { return all || topic.name == selected; }
  bool take(const Topic& topic, std::span<const std::byte>) override {
    taken.push_back(topic.name);
    return true;
  }
  void invalid(std::string_view channel, const std::string& error) override {
    problems.push_back(std::string(channel) + ": " + error);
  }

  bool all = true;
  std::string selected;
  std::vector<std::string> taken, problems;
};

TEST(TopicTable, HasATopicForAChannelAndForEachStandardType) {
  TopicTable table;
  Sink sink;
  EXPECT_FALSE(table.has("a.gps", static_cast<std::uint64_t>(shoal::gps_data_t::getHash())));
  EXPECT_TRUE(table.encode("a.gps", shoal::encode(shoal::gps_data_t{}), sink));
  EXPECT_THAT(sink.taken, ElementsAre("/a/gps", "/a/gps/fix"));
  EXPECT_TRUE(table.has("a.gps", static_cast<std::uint64_t>(shoal::gps_data_t::getHash())));
  EXPECT_EQ(table.topics()[1].type, "sensor_msgs/msg/NavSatFix");
  EXPECT_EQ(table.topics()[1].lcm_channel, "a.gps");
}

TEST(TopicTable, EncodesOnlyWhatIsWanted) {
  TopicTable table;
  Sink sink;
  sink.all = false;
  sink.selected = "/a/gps/fix";
  table.encode("a.gps", shoal::encode(shoal::gps_data_t{}), sink);
  table.encode("a.gps", shoal::encode(shoal::gps_data_t{}), sink);
  EXPECT_THAT(sink.taken, ElementsAre("/a/gps/fix", "/a/gps/fix"));
  sink.selected = "";
  table.encode("a.gps", shoal::encode(shoal::gps_data_t{}), sink);
  EXPECT_EQ(sink.taken.size(), 2u);
}

TEST(TopicTable, AnInvalidPayloadOfAnUnselectedTopicIsReported) {
  TopicTable table;
  Sink sink;
  table.encode("a.gps", shoal::encode(shoal::gps_data_t{}), sink);
  sink.all = false;
  sim::Bytes broken = shoal::encode(shoal::gps_data_t{});
  broken.pop_back();
  sink.selected = "/a/gps/fix";
  sink.taken.clear();
  EXPECT_TRUE(table.encode("a.gps", broken, sink));
  EXPECT_EQ(sink.problems.size(), 1u);
  EXPECT_THAT(sink.taken, IsEmpty());
}

}  // namespace
