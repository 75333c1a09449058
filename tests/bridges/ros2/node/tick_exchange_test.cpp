// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/node/tick_exchange.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bridges/ros2/node/node_types.hpp"
#include "shoal/message_codec.hpp"

namespace {

using bridges::ros2::decode_tick;
using bridges::ros2::Tick;
using bridges::ros2::TickExchange;
using testing::ElementsAre;
using testing::Pair;

Tick answer(const std::string& node, std::int64_t step, std::map<std::string, std::uint32_t> counts) {
  Tick tick;
  tick.step = step;
  tick.node = node;
  tick.counts = std::move(counts);
  return tick;
}

std::optional<TickExchange::Command> command(const std::string& channel) {
  return TickExchange::Command{channel, {}};
}

std::vector<std::string> channels_of(const std::vector<TickExchange::Command>& commands) {
  std::vector<std::string> channels;
  for (const auto& each : commands) channels.push_back(each.channel);
  return channels;
}

TEST(TickTest, IsReadAsItWasWritten) {
  const Tick tick{1'767'225'600'250'000, 25, 3, true, "pilot", {{"/a", 2}, {"/b", 7}}, {{"/a", 9}, {"/b", 8}}};
  const Tick read = decode_tick(encode(tick));
  EXPECT_EQ(read.utime, tick.utime);
  EXPECT_EQ(read.step, 25);
  EXPECT_EQ(read.branch, 3);
  EXPECT_TRUE(read.last);
  EXPECT_EQ(read.node, "pilot");
  EXPECT_THAT(read.counts, ElementsAre(Pair("/a", 2), Pair("/b", 7)));
  EXPECT_THAT(read.kept, ElementsAre(Pair("/a", 9), Pair("/b", 8)));
}

TEST(TickTest, BytesThatAreNotOfTheTypeAreRefused) {
  const std::vector<std::byte> bytes = encode(answer("pilot", 1, {{"/a", 1}}));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(decode_tick(std::span(bytes).first(size)), shoal::MessageError) << size;
}

TEST(TickTest, HasTheTypeHashOfItsDefinition) {
  EXPECT_THAT(bridges::ros2::type_hash(Tick::type, Tick::schema()), testing::StartsWith("RIHS01_"));
}

TEST(TickExchangeTest, ATickCountsTheMessagesSinceTheLastOne) {
  TickExchange exchange({"pilot"});
  exchange.count("/imu", 10);
  exchange.count("/imu", 10);
  EXPECT_THAT(exchange.begin(0, 1, 0, false).counts, ElementsAre(Pair("/imu", 2)));
  EXPECT_THAT(exchange.begin(0, 2, 0, false).counts, ElementsAre(Pair("/imu", 0)));
}

TEST(TickExchangeTest, ATickTellsHowManyMessagesANodeReceivesThatStartsNow) {
  TickExchange exchange({"pilot"});
  for (int i = 0; i < 2; ++i) exchange.count("/imu", 3);
  EXPECT_THAT(exchange.begin(0, 1, 0, false).kept, ElementsAre(Pair("/imu", 2)));
  for (int i = 0; i < 2; ++i) exchange.count("/imu", 3);
  exchange.count("/gps", 3);
  EXPECT_THAT(exchange.begin(0, 2, 0, false).kept, ElementsAre(Pair("/gps", 1), Pair("/imu", 3)));
}

TEST(TickExchangeTest, WaitsForAllNodesAndForTheCommandsThatTheyName) {
  TickExchange exchange({"a", "b"});
  exchange.begin(0, 5, 0, false);
  EXPECT_EQ(exchange.missing(), "the answer of 'a'");
  exchange.take(answer("a", 5, {{"/v/cmd", 2}}));
  exchange.take(answer("stranger", 5, {}));
  exchange.take(answer("b", 4, {}));  // to the tick before
  EXPECT_EQ(exchange.missing(), "the answer of 'b'");
  exchange.take(answer("b", 5, {}));
  exchange.add("/v/cmd", command("v"));
  EXPECT_EQ(exchange.missing(), "a message on /v/cmd");
  exchange.add("/v/cmd", std::nullopt);  // was refused: it came, too
  EXPECT_EQ(exchange.missing(), "");
  EXPECT_THAT(channels_of(exchange.finish()), ElementsAre("v"));
  EXPECT_THAT(exchange.finish(), testing::IsEmpty());
}

TEST(TickExchangeTest, CommandsAreInTheOrderOfTheirTopicsHoweverTheyCome) {
  TickExchange exchange({"a", "b"});
  exchange.begin(0, 1, 0, false);
  exchange.add("/b/cmd", command("b1"));
  exchange.add("/a/cmd", command("a"));
  exchange.add("/b/cmd", command("b2"));
  EXPECT_THAT(channels_of(exchange.finish()), ElementsAre("a", "b1", "b2"));
}

TEST(TickExchangeTest, TellsWhenTwoNodesSendToOneTopic) {
  TickExchange exchange({"a", "b"});
  exchange.begin(0, 1, 0, false);
  exchange.take(answer("a", 1, {{"/v/cmd", 1}}));
  exchange.take(answer("a", 1, {{"/v/cmd", 1}}));
  EXPECT_EQ(exchange.contested(), "");
  exchange.take(answer("b", 1, {{"/v/cmd", 0}}));
  EXPECT_EQ(exchange.contested(), "");
  exchange.take(answer("b", 1, {{"/v/cmd", 1}}));
  EXPECT_EQ(exchange.contested(), "/v/cmd");
}

TEST(TickExchangeTest, ASenderWithoutEndCostsBoundedMemory) {
  TickExchange exchange({"a"});
  exchange.begin(0, 1, 0, false);
  for (std::size_t i = 0; i < TickExchange::max_commands; ++i) EXPECT_TRUE(exchange.add("/v/cmd", command("v")));
  EXPECT_FALSE(exchange.add("/v/cmd", command("v")));
  EXPECT_EQ(exchange.finish().size(), TickExchange::max_commands);
}

}  // namespace
