#include "sim/run/client_mail.hpp"

#include <gtest/gtest.h>

#include "sim/bus/crc32.hpp"
#include "sim/bus/in_process_bus.hpp"

namespace {

sim::Bytes bytes_of(const std::string& text) {
  const auto* data = reinterpret_cast<const std::byte*>(text.data());
  return {data, data + text.size()};
}

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
  EXPECT_FALSE(test.mail.add("b", 1, "cmd", bytes_of("2")));
  EXPECT_TRUE(test.mail.add("a", 1, "cmd", bytes_of("2")));
  EXPECT_TRUE(test.mail.is_complete("a"));
  EXPECT_EQ(test.admitted(), "12");
}

TEST(ClientMail, DropsWhatComesASecondTime) {
  Sorted test;
  for (const char* text : {"1", "1", "s"}) test.arrive(text);
  test.mail.expect("a", {named("cmd", "1")});
  test.mail.collect();
  EXPECT_EQ(test.admitted(), "1s");
  test.arrive("1");  // late
  EXPECT_EQ(test.admitted(), "");
  EXPECT_EQ(test.mail.repeated(), 2u);
  // Said twice, it counts twice.
  test.arrive("1");
  test.mail.expect("a", {named("cmd", "1"), named("cmd", "1")});
  test.arrive("1");
  test.mail.collect();
  EXPECT_EQ(test.admitted(), "11");
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
