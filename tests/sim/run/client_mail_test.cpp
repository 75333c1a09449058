// SPDX-License-Identifier: BSD-3-Clause
#include "sim/run/client_mail.hpp"

#include <gtest/gtest.h>

#include "sim/base/crc32.hpp"
#include "sim/bus/in_process_bus.hpp"
#include "tests/bytes_of.hpp"

namespace {

using test_support::bytes_of;

sim::NamedMessage named(const std::string& channel, const std::string& text) {
  return {channel, sim::crc32(bytes_of(text))};
}

/// A gate whose mail is in the order of ClientMail, with a reader of the channel "cmd".
struct Sorted {
  Sorted() {
    gate.set_order([this](std::vector<sim::MailGate::Mail>& all) { mail.order(all); });
  }
  void arrive(const std::string& text) { network.publish("cmd", bytes_of(text), sim::Time(0)); }
  std::string admitted() {
    std::string all;
    for (const sim::MailGate::Mail& each : gate.admit())
      all.append(reinterpret_cast<const char*>(each.payload.data()), each.payload.size());
    return all;
  }

  sim::InProcessBus network;
  sim::MailGate gate{network};
  std::unique_ptr<sim::Mailbox> reader = gate.open_mailbox("cmd");
  sim::ClientMail mail{gate};
};

TEST(ClientMail, IsSortedByClientAndThenAsTheySay) {
  Sorted test;
  for (const char* text : {"s", "4", "2", "1", "3"}) test.arrive(text);
  test.mail.expect("b", {named("cmd", "3"), named("cmd", "4")});
  test.mail.expect("a", {named("cmd", "1"), named("nobody reads this", "x"), named("cmd", "2")});
  test.mail.collect();
  EXPECT_TRUE(test.mail.is_complete("a"));
  EXPECT_TRUE(test.mail.is_complete("b"));
  EXPECT_EQ(test.admitted(), "1234s");
}

TEST(ClientMail, KnowsWhatIsMissingAndTakesItWhenItIsSentAgain) {
  Sorted test;
  test.arrive("1");
  test.mail.expect("a", {named("cmd", "1"), named("cmd", "2")});
  test.mail.collect();
  EXPECT_EQ(test.mail.first_missing("a"), 1);
  EXPECT_FALSE(test.mail.add("a", 1, "cmd", bytes_of("3")));
  EXPECT_FALSE(test.mail.add("a", 2, "cmd", bytes_of("2")));
  EXPECT_TRUE(test.mail.add("b", 1, "cmd", bytes_of("2"))) << "of a list that was admitted: late, not wrong";
  EXPECT_TRUE(test.mail.add("a", 1, "cmd", bytes_of("2")));
  EXPECT_TRUE(test.mail.is_complete("a"));
  EXPECT_EQ(test.admitted(), "12");
}

TEST(ClientMail, DropsWhatComesASecondTimeOnce) {
  Sorted test;
  for (const char* text : {"1", "1", "s"}) test.arrive(text);
  test.mail.expect("a", {named("cmd", "1")});
  test.mail.collect();
  EXPECT_EQ(test.admitted(), "1s");
  test.arrive("1");  // somebody else's
  EXPECT_EQ(test.admitted(), "1");
  const auto repeated = test.mail.take_repeated();
  ASSERT_TRUE(repeated);
  EXPECT_EQ(repeated->client, "a");
  EXPECT_EQ(repeated->channel, "cmd");
  EXPECT_FALSE(test.mail.take_repeated());
  EXPECT_EQ(test.mail.repeated().at("a"), 1u);
  // Said twice, it counts twice.
  test.arrive("1");
  test.mail.expect("a", {named("cmd", "1"), named("cmd", "1")});
  test.arrive("1");
  test.mail.collect();
  EXPECT_EQ(test.admitted(), "11");
}

TEST(ClientMail, AMessageLikeOneOfAClientThatComesLaterIsSomebodyElses) {
  Sorted test;
  test.arrive("1");
  test.mail.expect("a", {named("cmd", "1")});
  EXPECT_EQ(test.admitted(), "1");
  for (std::int64_t i = 0; i < sim::ClientMail::repeat_windows; ++i) test.mail.next_window();
  EXPECT_EQ(test.admitted(), "");
  test.mail.next_window();
  test.arrive("1");
  EXPECT_EQ(test.admitted(), "1");
  EXPECT_TRUE(test.mail.repeated().empty());
}

TEST(ClientMail, WhatWasSentAgainMayComeLateOnce) {
  Sorted test;
  test.mail.expect("a", {named("cmd", "1")});
  test.mail.collect();
  EXPECT_TRUE(test.mail.add("a", 0, "cmd", bytes_of("1")));
  EXPECT_EQ(test.admitted(), "1");
  for (std::int64_t i = 0; i < sim::ClientMail::late_windows; ++i) test.mail.next_window();
  for (const char* text : {"1", "1"}) test.arrive(text);
  EXPECT_EQ(test.admitted(), "1");  // the first of them was the client's own
}

TEST(ClientMail, AfterClearingOnlyWhatIsOnItsWayIsDropped) {
  Sorted test;
  test.arrive("1");
  test.mail.expect("a", {named("cmd", "1")});
  EXPECT_EQ(test.admitted(), "1");
  test.mail.expect("a", {named("cmd", "2")});
  test.mail.clear();
  for (const char* text : {"1", "2", "3"}) test.arrive(text);
  EXPECT_EQ(test.admitted(), "13");
  EXPECT_FALSE(test.mail.take_repeated());
}

TEST(ClientMail, OfOneChannelOnlySoManyWaitAndTheOthersStay) {
  Sorted test;
  const auto other = test.gate.open_mailbox("other");
  test.network.publish("other", bytes_of("o"), sim::Time(0));
  for (std::size_t i = 0; i < sim::ClientMail::most_of_channel + 500; ++i) {
    test.arrive(std::to_string(i) + " ");
    if (i % 100 == 0) test.mail.collect();
  }
  test.mail.collect();
  EXPECT_EQ(test.mail.dropped(), 500u);
  const std::string admitted = test.admitted();
  EXPECT_EQ(admitted.substr(0, 5), "o500 ");
}

TEST(ClientMail, DropsWhatWasNamedForATickThatCountsNoMore) {
  Sorted test;
  for (const char* text : {"1", "2"}) test.arrive(text);
  test.mail.collect();
  test.mail.drop("a", {named("cmd", "1"), named("cmd", "3")});
  test.arrive("3");
  EXPECT_EQ(test.admitted(), "2");
  EXPECT_FALSE(test.mail.take_repeated());  // it is late, and no copy
  EXPECT_TRUE(test.mail.repeated().empty());
}

TEST(ClientMail, CountsWhatIsRepeatedForSoManyClients) {
  Sorted test;
  const auto repeat = [&](std::size_t client) {
    const std::string name = std::to_string(client);
    for (int i = 0; i < 2; ++i) test.arrive(name);
    test.mail.expect(name, {named("cmd", name)});
    EXPECT_EQ(test.admitted(), name);
  };
  for (std::size_t i = 0; i < sim::ClientMail::most_names + 10; ++i) repeat(i);
  repeat(0);
  EXPECT_EQ(test.mail.repeated().size(), sim::ClientMail::most_names);
  EXPECT_EQ(test.mail.repeated().at("0"), 2u);
}

TEST(ClientMail, DropsAllThatHasComeWhenItCannotBeToldWhoseItIs) {
  Sorted test;
  for (const char* text : {"1", "2"}) test.arrive(text);
  test.mail.collect();
  test.mail.drop_unnamed();
  test.arrive("3");
  EXPECT_EQ(test.admitted(), "3");
  EXPECT_EQ(test.mail.dropped(), 2u);
}

TEST(ClientMail, OfAClientThatIsGoneWhatHasComeIsAdmitted) {
  Sorted test;
  test.arrive("2");
  test.mail.expect("a", {named("cmd", "1"), named("cmd", "2")});
  test.mail.collect();
  EXPECT_FALSE(test.mail.is_complete("a"));
  test.mail.give_up("a");
  EXPECT_TRUE(test.mail.is_complete("a"));
  EXPECT_EQ(test.admitted(), "2");
}

}  // namespace
