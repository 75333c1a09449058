// SPDX-License-Identifier: BSD-3-Clause
#include "sim/run/client_messages.hpp"

#include <gtest/gtest.h>

#include "sim/base/crc32.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "tests/bytes_of.hpp"

namespace {

using test_support::bytes_of;

sim::NamedMessage named(const std::string& channel, const std::string& text) {
  return {channel, sim::crc32(bytes_of(text))};
}

/// A gate whose messages are in the order of ClientMessages, with a reader of the channel "cmd".
struct Sorted {
  Sorted() {
    gate.set_order([this](std::vector<sim::MessageGate::Delivery>& all) { inputs.order(all); });
  }
  void arrive(const std::string& text) { network.publish("cmd", bytes_of(text), sim::Time(0)); }
  std::string admitted() {
    std::string all;
    for (const sim::MessageGate::Delivery& each : gate.admit())
      all.append(reinterpret_cast<const char*>(each.payload.data()), each.payload.size());
    return all;
  }

  sim::InProcessBus network;
  sim::MessageGate gate{network};
  std::unique_ptr<sim::Mailbox> reader = gate.open_mailbox("cmd");
  sim::ClientMessages inputs{gate};
};

TEST(ClientMessages, IsSortedByClientAndThenAsTheySay) {
  Sorted test;
  for (const char* text : {"s", "4", "2", "1", "3"}) test.arrive(text);
  test.inputs.expect("b", {named("cmd", "3"), named("cmd", "4")});
  test.inputs.expect("a", {named("cmd", "1"), named("nobody reads this", "x"), named("cmd", "2")});
  test.inputs.collect();
  EXPECT_TRUE(test.inputs.is_complete("a"));
  EXPECT_TRUE(test.inputs.is_complete("b"));
  EXPECT_EQ(test.admitted(), "1234s");
}

TEST(ClientMessages, KnowsWhatIsMissingAndTakesItWhenItIsSentAgain) {
  Sorted test;
  test.arrive("1");
  test.inputs.expect("a", {named("cmd", "1"), named("cmd", "2")});
  test.inputs.collect();
  EXPECT_EQ(test.inputs.first_missing("a"), 1);
  EXPECT_FALSE(test.inputs.add("a", 1, "cmd", bytes_of("3")));
  EXPECT_FALSE(test.inputs.add("a", 2, "cmd", bytes_of("2")));
  EXPECT_TRUE(test.inputs.add("b", 1, "cmd", bytes_of("2"))) << "of a list that was admitted: late, not wrong";
  EXPECT_TRUE(test.inputs.add("a", 1, "cmd", bytes_of("2")));
  EXPECT_TRUE(test.inputs.is_complete("a"));
  EXPECT_EQ(test.admitted(), "12");
}

TEST(ClientMessages, DropsWhatComesASecondTimeOnce) {
  Sorted test;
  for (const char* text : {"1", "1", "s"}) test.arrive(text);
  test.inputs.expect("a", {named("cmd", "1")});
  test.inputs.collect();
  EXPECT_EQ(test.admitted(), "1s");
  test.arrive("1");  // someone else's
  EXPECT_EQ(test.admitted(), "1");
  const auto repeated = test.inputs.take_repeated();
  ASSERT_TRUE(repeated);
  EXPECT_EQ(repeated->client, "a");
  EXPECT_EQ(repeated->channel, "cmd");
  EXPECT_FALSE(test.inputs.take_repeated());
  EXPECT_EQ(test.inputs.repeated().at("a"), 1u);
  // Said twice, it counts twice.
  test.arrive("1");
  test.inputs.expect("a", {named("cmd", "1"), named("cmd", "1")});
  test.arrive("1");
  test.inputs.collect();
  EXPECT_EQ(test.admitted(), "11");
}

TEST(ClientMessages, AMessageLikeOneOfAClientThatComesLaterIsSomeOneElses) {
  Sorted test;
  test.arrive("1");
  test.inputs.expect("a", {named("cmd", "1")});
  EXPECT_EQ(test.admitted(), "1");
  for (std::int64_t i = 0; i < sim::ClientMessages::repeat_windows; ++i) test.inputs.next_window();
  EXPECT_EQ(test.admitted(), "");
  test.inputs.next_window();
  test.arrive("1");
  EXPECT_EQ(test.admitted(), "1");
  EXPECT_TRUE(test.inputs.repeated().empty());
}

TEST(ClientMessages, WhatWasSentAgainMayComeLateOnce) {
  Sorted test;
  test.inputs.expect("a", {named("cmd", "1")});
  test.inputs.collect();
  EXPECT_TRUE(test.inputs.add("a", 0, "cmd", bytes_of("1")));
  EXPECT_EQ(test.admitted(), "1");
  for (std::int64_t i = 0; i < sim::ClientMessages::late_windows; ++i) test.inputs.next_window();
  for (const char* text : {"1", "1"}) test.arrive(text);
  EXPECT_EQ(test.admitted(), "1");  // the first of them was the client's own
}

TEST(ClientMessages, AfterClearingOnlyWhatIsOnItsWayIsDropped) {
  Sorted test;
  test.arrive("1");
  test.inputs.expect("a", {named("cmd", "1")});
  EXPECT_EQ(test.admitted(), "1");
  test.inputs.expect("a", {named("cmd", "2")});
  test.inputs.clear();
  for (const char* text : {"1", "2", "3"}) test.arrive(text);
  EXPECT_EQ(test.admitted(), "13");
  EXPECT_FALSE(test.inputs.take_repeated());
}

TEST(ClientMessages, OfOneChannelOnlyManyWaitAndTheOthersStay) {
  Sorted test;
  const auto other = test.gate.open_mailbox("other");
  test.network.publish("other", bytes_of("o"), sim::Time(0));
  for (std::size_t i = 0; i < sim::ClientMessages::max_of_channel + 500; ++i) {
    test.arrive(std::to_string(i) + " ");
    if (i % 100 == 0) test.inputs.collect();
  }
  test.inputs.collect();
  EXPECT_EQ(test.inputs.dropped(), 500u);
  const std::string admitted = test.admitted();
  EXPECT_EQ(admitted.substr(0, 5), "o500 ");
}

TEST(ClientMessages, DropsWhatWasNamedForATickThatCountsNoMore) {
  Sorted test;
  for (const char* text : {"1", "2"}) test.arrive(text);
  test.inputs.collect();
  test.inputs.drop("a", {named("cmd", "1"), named("cmd", "3")});
  test.arrive("3");
  EXPECT_EQ(test.admitted(), "2");
  EXPECT_FALSE(test.inputs.take_repeated());  // it is late, and no copy
  EXPECT_TRUE(test.inputs.repeated().empty());
}

TEST(ClientMessages, CountsWhatIsRepeatedForManyClients) {
  Sorted test;
  const auto repeat = [&](std::size_t client) {
    const std::string name = std::to_string(client);
    for (int i = 0; i < 2; ++i) test.arrive(name);
    test.inputs.expect(name, {named("cmd", name)});
    EXPECT_EQ(test.admitted(), name);
  };
  for (std::size_t i = 0; i < sim::ClientMessages::max_names + 10; ++i) repeat(i);
  repeat(0);
  EXPECT_EQ(test.inputs.repeated().size(), sim::ClientMessages::max_names);
  EXPECT_EQ(test.inputs.repeated().at("0"), 2u);
}

TEST(ClientMessages, DropsAllThatHasComeWhenItCannotBeToldWhoseItIs) {
  Sorted test;
  for (const char* text : {"1", "2"}) test.arrive(text);
  test.inputs.collect();
  test.inputs.drop_unnamed();
  test.arrive("3");
  EXPECT_EQ(test.admitted(), "3");
  EXPECT_EQ(test.inputs.dropped(), 2u);
}

TEST(ClientMessages, OfAClientThatIsGoneWhatHasComeIsAdmitted) {
  Sorted test;
  test.arrive("2");
  test.inputs.expect("a", {named("cmd", "1"), named("cmd", "2")});
  test.inputs.collect();
  EXPECT_FALSE(test.inputs.is_complete("a"));
  test.inputs.give_up("a");
  EXPECT_TRUE(test.inputs.is_complete("a"));
  EXPECT_EQ(test.admitted(), "2");
}

}  // namespace
