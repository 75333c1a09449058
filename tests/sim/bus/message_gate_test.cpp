// SPDX-License-Identifier: BSD-3-Clause
#include "sim/bus/message_gate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "sim/bus/in_process_bus.hpp"
#include "tests/bytes_of.hpp"

namespace {

using sim::Bytes;
using sim::MessageGate;
using sim::Time;
using testing::ElementsAre;
using testing::IsEmpty;

using test_support::bytes_of;

std::string text_of(std::span<const std::byte> payload) {
  return {reinterpret_cast<const char*>(payload.data()), payload.size()};
}

/// A network where `from_afar` publishes; what the gate publishes comes back at once.
class MessageGateTest : public testing::Test {
 protected:
  void from_afar(const std::string& channel, const std::string& text) {
    network.publish(channel, bytes_of(text), Time{0});
  }
  void from_here(const std::string& channel, const std::string& text) {
    gate.publish(channel, bytes_of(text), Time{0});
  }

  static std::vector<std::string> all_of(sim::Mailbox& mailbox) {
    std::vector<std::string> texts;
    while (const auto message = mailbox.take()) texts.push_back(text_of(message->payload));
    return texts;
  }

  std::vector<std::string> admit() {
    std::vector<std::string> texts;
    for (const MessageGate::Delivery& inputs : gate.admit())
      texts.push_back(inputs.channel + ":" + text_of(inputs.payload));
    return texts;
  }

  sim::InProcessBus network;
  MessageGate gate{network};
};

TEST_F(MessageGateTest, WhatComesFromOutsideWaitsUntilItIsAdmitted) {
  const auto mailbox = gate.open_mailbox("a");
  from_afar("a", "one");
  EXPECT_THAT(all_of(*mailbox), IsEmpty());
  EXPECT_THAT(admit(), ElementsAre("a:one"));
  const auto message = mailbox->take();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->channel, "a");
  EXPECT_EQ(text_of(message->payload), "one");
  EXPECT_TRUE(message->from_outside);
  EXPECT_THAT(admit(), IsEmpty());
}

TEST_F(MessageGateTest, WhatIsPublishedHereIsThereAtOnceAndOnce) {
  const auto mailbox = gate.open_mailbox("a");
  from_here("a", "own");
  const auto message = mailbox->take();
  ASSERT_TRUE(message);
  EXPECT_EQ(text_of(message->payload), "own");
  EXPECT_FALSE(message->from_outside);
  EXPECT_THAT(admit(), IsEmpty());
  EXPECT_THAT(all_of(*mailbox), IsEmpty());
}

TEST_F(MessageGateTest, WhatIsPublishedHereReachesTheNetwork) {
  const auto afar = network.open_mailbox("a", 10);
  const auto mailbox = gate.open_mailbox("a");
  from_here("a", "own");
  from_here("b", "unread");
  EXPECT_THAT(all_of(*afar), ElementsAre("own"));
  EXPECT_EQ(gate.counts().published, 2u);
}

TEST_F(MessageGateTest, WhatWaitsWhileSomethingIsPublishedHereIsNotTakenForTheEcho) {
  const auto mailbox = gate.open_mailbox("a");
  from_afar("a", "one");
  from_here("a", "own");
  from_afar("a", "two");
  EXPECT_THAT(all_of(*mailbox), ElementsAre("own"));
  EXPECT_THAT(admit(), ElementsAre("a:one", "a:two"));
  EXPECT_THAT(all_of(*mailbox), ElementsAre("one", "two"));
}

TEST_F(MessageGateTest, AllReadersOfAChannelSeeAMessageInTheSameStep) {
  const auto first = gate.open_mailbox("a");
  const auto second = gate.open_mailbox("a");
  from_afar("a", "one");
  admit();
  from_afar("a", "two");
  EXPECT_THAT(all_of(*first), ElementsAre("one"));
  EXPECT_THAT(all_of(*second), ElementsAre("one"));
  admit();
  EXPECT_THAT(all_of(*first), ElementsAre("two"));
  EXPECT_THAT(all_of(*second), ElementsAre("two"));
}

TEST_F(MessageGateTest, WhoReadsOnlyWhenItsFlagIsRaisedMissesNothing) {
  const auto mailbox = gate.open_mailbox("a");
  const auto flag = std::make_shared<std::atomic<bool>>(false);
  mailbox->raise_on_arrival(flag);
  from_afar("a", "one");
  EXPECT_FALSE(*flag);
  admit();
  EXPECT_TRUE(flag->exchange(false));
  all_of(*mailbox);
  from_here("a", "own");
  EXPECT_TRUE(flag->exchange(false));
  const auto late = std::make_shared<std::atomic<bool>>(false);
  mailbox->raise_on_arrival(late);
  EXPECT_TRUE(*late) << "something waits already";
}

TEST_F(MessageGateTest, WhatIsAdmittedIsInTheOrderOfTheChannelsAndThenOfArrival) {
  const auto b = gate.open_mailbox("b");
  const auto a = gate.open_mailbox("a");
  from_afar("a", "1");
  from_afar("b", "2");
  from_afar("a", "3");
  EXPECT_THAT(admit(), ElementsAre("b:2", "a:1", "a:3"));
}

TEST_F(MessageGateTest, WhatWaitsCanBeOrderedAndAddedTo) {
  const auto mailbox = gate.open_mailbox("a");
  from_afar("a", "two");
  EXPECT_TRUE(gate.collect());
  gate.waiting().insert(gate.waiting().begin(), {"a", bytes_of("one")});
  EXPECT_THAT(admit(), ElementsAre("a:one", "a:two"));
  EXPECT_THAT(all_of(*mailbox), ElementsAre("one", "two"));
  EXPECT_FALSE(gate.collect());
}

TEST_F(MessageGateTest, WhoOrdersTheInputsHasTheLastWordBeforeItIsGiven) {
  const auto mailbox = gate.open_mailbox("a");
  EXPECT_TRUE(gate.reads("a"));
  EXPECT_FALSE(gate.reads("b"));
  gate.set_order([](std::vector<MessageGate::Delivery>& inputs) {
    if (inputs.size() > 1) std::swap(inputs[0], inputs[1]);
    if (inputs.size() > 2) inputs.pop_back();
  });
  for (const char* text : {"1", "2", "3"}) from_afar("a", text);
  EXPECT_THAT(admit(), ElementsAre("a:2", "a:1"));
  EXPECT_THAT(all_of(*mailbox), ElementsAre("2", "1"));
}

TEST_F(MessageGateTest, AFullMailboxDropsTheOldestAndCounts) {
  const auto small = gate.open_mailbox("a", 2);
  const auto large = gate.open_mailbox("a", 3);
  for (const char* text : {"1", "2", "3", "4"}) from_afar("a", text);
  // The larger one holds three, so that one of four is dropped before it is admitted.
  EXPECT_THAT(admit(), ElementsAre("a:2", "a:3", "a:4"));
  EXPECT_THAT(all_of(*large), ElementsAre("2", "3", "4"));
  EXPECT_THAT(all_of(*small), ElementsAre("3", "4"));
  EXPECT_EQ(large->dropped(), 0u);
  EXPECT_EQ(small->dropped(), 1u);
  EXPECT_EQ(gate.counts().dropped_incoming, 2u);
}

TEST_F(MessageGateTest, AFloodThatIsNeverAdmittedIsBounded) {
  const auto mailbox = gate.open_mailbox("a", 5);
  for (int i = 0; i < 100; ++i) {
    from_afar("a", std::to_string(i));
    gate.collect();
  }
  EXPECT_THAT(admit(), ElementsAre("a:95", "a:96", "a:97", "a:98", "a:99"));
  EXPECT_EQ(gate.counts().dropped_incoming, 95u);
}

TEST_F(MessageGateTest, AChannelThatNoOneReadsAnyMoreIsLeft) {
  auto mailbox = gate.open_mailbox("a");
  from_afar("a", "one");
  gate.collect();
  mailbox.reset();
  from_afar("a", "two");
  EXPECT_THAT(admit(), IsEmpty());
  const auto again = gate.open_mailbox("a");
  const auto other = gate.open_mailbox("b");
  from_afar("b", "three");
  from_afar("a", "four");
  EXPECT_THAT(admit(), ElementsAre("a:four", "b:three"));
  EXPECT_THAT(all_of(*again), ElementsAre("four"));
}

TEST_F(MessageGateTest, WhoWatchesSeesAllThatIsPublishedHere) {
  std::vector<std::string> seen;
  gate.set_watch([&](std::string_view channel, std::span<const std::byte> payload) {
    seen.push_back(std::string(channel) + ":" + text_of(payload));
  });
  const auto mailbox = gate.open_mailbox("a");
  from_here("a", "one");
  from_here("b", "two");
  from_afar("a", "three");
  admit();
  EXPECT_THAT(seen, ElementsAre("a:one", "b:two"));
  gate.set_watch({});
  from_here("a", "four");
  EXPECT_EQ(seen.size(), 2u);
}

TEST_F(MessageGateTest, WhatIsUnreadCanBeSavedAndPutBack) {
  const auto mailbox = gate.open_mailbox("a");
  const auto flag = std::make_shared<std::atomic<bool>>(false);
  mailbox->raise_on_arrival(flag);
  from_here("a", "one");
  from_here("a", "two");
  const auto saved = mailbox->unread();
  EXPECT_THAT(all_of(*mailbox), ElementsAre("one", "two"));
  from_here("a", "three");
  *flag = false;
  mailbox->set_unread(saved);
  EXPECT_TRUE(*flag);
  EXPECT_THAT(all_of(*mailbox), ElementsAre("one", "two"));
}

TEST_F(MessageGateTest, AGateInFrontOfAGateWorks) {
  MessageGate inner_room(static_cast<sim::Bus&>(gate));
  const auto mailbox = inner_room.open_mailbox("a");
  from_afar("a", "one");
  gate.admit();
  EXPECT_THAT(all_of(*mailbox), IsEmpty());
  inner_room.admit();
  EXPECT_THAT(all_of(*mailbox), ElementsAre("one"));
}

TEST_F(MessageGateTest, RefusesChannelNamesThatTheNetworkRefuses) {
  EXPECT_THROW(gate.open_mailbox(""), std::invalid_argument);
  EXPECT_THROW(gate.open_mailbox(std::string(64, 'a')), std::invalid_argument);
  EXPECT_THROW(gate.publish("", {}, Time{0}), std::invalid_argument);
}

/// A network on which messages arrive faster than they can be read.
class FloodedBus final : public sim::Bus {
 public:
  void publish(std::string_view, std::span<const std::byte>, Time) override {}
  std::unique_ptr<sim::Mailbox> open_mailbox(const std::string&, std::size_t) override {
    return std::make_unique<Flood>(*this);
  }
  sim::BusCounts counts() const override { return {}; }
  int taken = 0;

 private:
  class Flood final : public sim::Mailbox {
   public:
    explicit Flood(FloodedBus& bus) : bus_(bus) {}
    std::optional<sim::Message> take() override {
      if (bus_.taken >= 10'000) return std::nullopt;  // so that the test ends
      return sim::Message{"a", bytes_of(std::to_string(++bus_.taken)), true};
    }
    std::uint64_t dropped() const override { return 0; }
    void raise_on_arrival(std::shared_ptr<std::atomic<bool>> flag) override { *flag = true; }
    std::vector<sim::Message> unread() const override { return {}; }
    void set_unread(std::vector<sim::Message>) override {}

   private:
    FloodedBus& bus_;
  };
};

TEST(FloodedMessageGate, TakesNoMoreThanAMailboxHoldsAtOnceAndContinuesLater) {
  FloodedBus network;
  MessageGate gate(network);
  const auto mailbox = gate.open_mailbox("a", 5);
  const int max = static_cast<int>(sim::Bus::default_mailbox_capacity);
  EXPECT_TRUE(gate.collect());
  EXPECT_EQ(network.taken, max);
  ASSERT_EQ(gate.waiting().size(), 5u);
  EXPECT_EQ(text_of(gate.waiting().back().payload), std::to_string(max));
  EXPECT_EQ(gate.counts().dropped_incoming, static_cast<std::uint64_t>(max - 5));
  EXPECT_TRUE(gate.collect());
  EXPECT_EQ(network.taken, 2 * max);
}

TEST_F(MessageGateTest, AnOpenChannelFollowsReadersThatComeAndGo) {
  std::vector<std::string> watched;
  gate.set_watch([&](std::string_view channel, std::span<const std::byte> payload) {
    watched.push_back(std::string(channel) + ":" + text_of(payload));
  });
  const auto channel = gate.open_channel("a");
  const auto publish = [&](const std::string& text) { channel->publish(bytes_of(text), Time{0}); };
  const auto listener = network.open_mailbox("a", 10);
  publish("one");
  auto first = gate.open_mailbox("a");
  publish("two");
  const auto second = gate.open_mailbox("a");
  publish("three");
  EXPECT_THAT(all_of(*first), ElementsAre("two", "three"));
  EXPECT_THAT(all_of(*second), ElementsAre("three"));
  first.reset();
  publish("four");
  EXPECT_THAT(all_of(*second), ElementsAre("four"));
  EXPECT_THAT(admit(), IsEmpty()) << "what it published itself";
  EXPECT_THAT(all_of(*listener), ElementsAre("one", "two", "three", "four"));
  EXPECT_THAT(watched, ElementsAre("a:one", "a:two", "a:three", "a:four"));
}

TEST_F(MessageGateTest, AnOpenChannelKeepsTheOrderOfEarlierMessagesFromOutside) {
  const auto mailbox = gate.open_mailbox("a");
  const auto channel = gate.open_channel("a");
  from_afar("a", "earlier");
  channel->publish(bytes_of("own"), Time{0});
  EXPECT_THAT(all_of(*mailbox), ElementsAre("own"));
  EXPECT_THAT(admit(), ElementsAre("a:earlier"));
}

}  // namespace
