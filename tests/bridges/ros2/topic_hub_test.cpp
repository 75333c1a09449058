// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/topic_hub.hpp"

#include <gmock/gmock.h>

#include "shoal/message_codec.hpp"
#include "shoal/sim_scene_t.hpp"
#include "shoal/utime_t.hpp"

namespace {

using namespace bridges::ros2;

/// Subscriber of one topic.
class Reader final : public TopicReader {
 public:
  bool has_subscribed(std::size_t number) const override { return topic == number; }
  void push(const Topic&, const ChannelMessage& from, const Bytes&) override { times.push_back(from.utime); }
  std::optional<std::size_t> topic;
  std::vector<std::int64_t> times;
};

class TopicHubTest : public testing::Test {
 protected:
  TopicHubTest() { hub_.add(reader_); }
  template <class Message>
  void publish(std::int64_t utime, const std::string& channel, const Message& message) {
    ChannelMessage entry{utime, channel, shoal::encode(message)};
    hub_.encode(entry);
  }
  Need need(const std::string& channel, bool has_readers = true) {
    return hub_.need(channel, shoal::encode(shoal::utime_t{1}), has_readers);
  }
  void subscribe(const std::string& name) {
    for (const Topic& topic : hub_.topics())
      if (topic.name == name) reader_.topic = topic.number;
    hub_.count_subscription(reader_.topic.value(), 1);
  }

  TopicHub hub_;
  Reader reader_;
};

TEST_F(TopicHubTest, AChannelIsNeededWhileATopicOfItIsSubscribed) {
  EXPECT_EQ(need("a"), Need::examined);
  publish(1, "a", shoal::utime_t{1});
  subscribe("/a");
  EXPECT_EQ(need("a"), Need::subscribed);
  publish(2, "a", shoal::utime_t{1});
  EXPECT_THAT(reader_.times, testing::ElementsAre(2));
  hub_.count_subscription(*reader_.topic, -1);
  // The first twenty of a channel are examined, then each fiftieth: of the messages 2 to 49 those up to 19.
  int examined = 0;
  for (int i = 2; i < 50; ++i) examined += need("a") == Need::examined ? 1 : 0;
  EXPECT_EQ(examined, 18);
}

TEST_F(TopicHubTest, WithoutReadersOnlyNewChannelsAreExaminedAndScenesKept) {
  EXPECT_EQ(need("a", false), Need::examined);
  EXPECT_EQ(need("a", false), Need::none);
  EXPECT_EQ(need("sim.scene", false), Need::kept);
  EXPECT_EQ(need("sim.scene", false), Need::kept);
}

TEST_F(TopicHubTest, ALaterReaderGetsTheLastMessageOfALatchedTopic) {
  shoal::sim_scene_t scene{};
  scene.scene = R"({"op":"scene","bodies":[{"id":0,"name":"box","owner":"box","fixed":true,
      "parts":[{"shape":"box","size_m":[1,2,3]}]}]})";
  publish(1, "sim.scene", scene);
  publish(2, "sim.scene", scene);
  subscribe("/scene");
  hub_.send_latched(reader_, *reader_.topic);
  EXPECT_THAT(reader_.times, testing::ElementsAre(2));
}

TEST(TopicHubWithoutReaders, EncodesNothingUntilOneComesWhichHasAllTopicsAndTheLastScene) {
  TopicHub hub;
  const auto encode = [&](std::int64_t utime, const std::string& channel, const auto& message) {
    ChannelMessage entry{utime, channel, shoal::encode(message)};
    hub.encode(entry);
  };
  shoal::sim_scene_t scene{};
  scene.scene = R"({"op":"scene","bodies":[]})";
  encode(1, "a", shoal::utime_t{1});
  for (int i = 2; i <= 5; ++i) encode(i, "sim.scene", scene);
  encode(6, "b", shoal::utime_t{1});
  EXPECT_THAT(hub.topics(), testing::IsEmpty());
  Reader reader;
  hub.add(reader);
  std::vector<std::string> names;
  for (const Topic& topic : hub.topics()) names.push_back(topic.name);
  EXPECT_THAT(names, testing::ElementsAre("/a", "/sim/scene", "/scene", "/b"));
  reader.topic = 2;
  hub.count_subscription(2, 1);
  hub.send_latched(reader, 2);
  EXPECT_THAT(reader.times, testing::ElementsAre(5));
  encode(7, "sim.scene", scene);
  EXPECT_THAT(reader.times, testing::ElementsAre(5, 7));
}

TEST(WaitingMessages, ThoseWithoutRoomAreCountedIfSomeoneWantsThemAndKeptOnesHaveRoom) {
  WaitingMessages waiting;
  const std::vector<std::byte> half(WaitingMessages::max_bytes / 2);
  EXPECT_TRUE(waiting.add(Need::subscribed, 0, "a", half));
  EXPECT_TRUE(waiting.add(Need::subscribed, 0, "a", half));
  EXPECT_FALSE(waiting.add(Need::subscribed, 0, "a", half));
  EXPECT_FALSE(waiting.add(Need::examined, 0, "a", half));
  EXPECT_EQ(waiting.dropped, 1u);
  EXPECT_TRUE(waiting.add(Need::kept, 0, "sim.scene", half));
  waiting.add_jump(1);
  waiting.add_jump(2);
  EXPECT_EQ(waiting.messages.size(), 4u);
  EXPECT_EQ(waiting.messages.back().utime, 2);
}

}  // namespace
