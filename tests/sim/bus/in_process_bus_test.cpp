// SPDX-License-Identifier: BSD-3-Clause
#include "sim/bus/in_process_bus.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "tests/bytes_of.hpp"

namespace {

using sim::Bytes;
using sim::InProcessBus;
using sim::Time;

using test_support::bytes_of;

std::string text_of(const std::optional<sim::Message>& message) {
  if (!message) return "nothing";
  std::string text;
  for (const std::byte byte : message->payload) text += static_cast<char>(byte);
  return text;
}

class InProcessBusTest : public testing::Test {
 protected:
  void publish(const std::string& channel, const std::string& text) { bus.publish(channel, bytes_of(text), Time{0}); }

  InProcessBus bus;
};

TEST_F(InProcessBusTest, DeliversInTheOrderOfPublishing) {
  const auto mailbox = bus.open_mailbox("a", 10);
  publish("a", "one");
  publish("b", "other");
  publish("a", "two");
  EXPECT_EQ(text_of(mailbox->take()), "one");
  EXPECT_EQ(text_of(mailbox->take()), "two");
  EXPECT_EQ(text_of(mailbox->take()), "nothing");
}

TEST_F(InProcessBusTest, AMessageKnowsItsChannelAndThatItIsFromHere) {
  const auto mailbox = bus.open_mailbox("rover1.drive.cmd", 10);
  publish("rover1.drive.cmd", "");
  const auto message = mailbox->take();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->channel, "rover1.drive.cmd");
  EXPECT_FALSE(message->from_outside);
  EXPECT_TRUE(message->payload.empty());
}

TEST_F(InProcessBusTest, EverySubscriberHasAMailboxOfItsOwn) {
  const auto first = bus.open_mailbox("a", 10);
  const auto second = bus.open_mailbox("a", 10);
  publish("a", "x");
  EXPECT_EQ(text_of(first->take()), "x");
  EXPECT_EQ(text_of(second->take()), "x");
  EXPECT_EQ(bus.counts().published, 1u);
  EXPECT_EQ(bus.counts().received, 2u);
}

TEST_F(InProcessBusTest, AFullMailboxDropsTheOldestAndCounts) {
  const auto small = bus.open_mailbox("a", 2);
  const auto large = bus.open_mailbox("a", 10);
  for (const char* text : {"1", "2", "3", "4"}) publish("a", text);
  EXPECT_EQ(small->dropped(), 2u);
  EXPECT_EQ(large->dropped(), 0u);
  EXPECT_EQ(bus.counts().dropped_incoming, 2u);
  EXPECT_EQ(text_of(small->take()), "3");
  EXPECT_EQ(text_of(small->take()), "4");
  EXPECT_EQ(text_of(small->take()), "nothing");
  EXPECT_EQ(text_of(large->take()), "1");
}

TEST_F(InProcessBusTest, AMailboxWithoutRoomDropsEverything) {
  const auto mailbox = bus.open_mailbox("a", 0);
  publish("a", "x");
  EXPECT_EQ(text_of(mailbox->take()), "nothing");
  EXPECT_EQ(mailbox->dropped(), 1u);
}

TEST_F(InProcessBusTest, CountsWhatNoOneReceives) {
  publish("a", "x");
  const auto late = bus.open_mailbox("a", 10);
  EXPECT_EQ(bus.counts().published, 1u);
  EXPECT_EQ(bus.counts().received, 0u);
  EXPECT_EQ(text_of(late->take()), "nothing");
}

TEST_F(InProcessBusTest, AClosedMailboxReceivesNoMore) {
  auto mailbox = bus.open_mailbox("a", 1);
  publish("a", "x");
  mailbox.reset();
  publish("a", "y");
  EXPECT_EQ(bus.counts().received, 1u);
  EXPECT_EQ(bus.counts().dropped_incoming, 0u);
}

TEST_F(InProcessBusTest, ChannelNamesHave1To63Characters) {
  const std::string longest(63, 'c');
  const auto mailbox = bus.open_mailbox(longest, 10);
  publish(longest, "x");
  EXPECT_EQ(text_of(mailbox->take()), "x");
  EXPECT_THROW(publish("", "x"), std::invalid_argument);
  EXPECT_THROW(publish(longest + "c", "x"), std::invalid_argument);
  EXPECT_THROW(bus.open_mailbox("", 10), std::invalid_argument);
  EXPECT_THROW(bus.open_mailbox(longest + "c", 10), std::invalid_argument);
  EXPECT_EQ(bus.counts().published, 1u);
}

TEST_F(InProcessBusTest, AnOpenChannelPublishesToMailboxesOpenedBeforeAndAfterIt) {
  const auto before = bus.open_mailbox("a", 10);
  const auto channel = bus.open_channel("a");
  auto after = bus.open_mailbox("a", 10);
  channel->publish(bytes_of("one"), Time{0});
  EXPECT_EQ(text_of(before->take()), "one");
  EXPECT_EQ(text_of(after->take()), "one");
  after.reset();
  channel->publish(bytes_of("two"), Time{0});
  const auto message = before->take();
  EXPECT_EQ(text_of(message), "two");
  EXPECT_EQ(message->channel, "a");
  EXPECT_EQ(bus.counts().published, 2u);
  EXPECT_EQ(bus.counts().received, 3u);
}

TEST_F(InProcessBusTest, RefusesToOpenAChannelWithoutAName) {
  EXPECT_THROW(bus.open_channel(""), std::invalid_argument);
  EXPECT_THROW(bus.open_channel(std::string(64, 'a')), std::invalid_argument);
}

}  // namespace
