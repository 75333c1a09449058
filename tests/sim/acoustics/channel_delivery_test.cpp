// SPDX-License-Identifier: BSD-3-Clause
// Who receives a signal, what overlaps, and what is counted.

#include "sim/world/world_editor.hpp"
#include "tests/sim/acoustics/sea_of_hydrophones.hpp"

namespace {

using namespace std::chrono_literals;
using sim::Signal;
using sim::SignalLoss;
using test::lost;
using test::message;
using test::phone;
using test::sea;
using test::TestWorld;
using test::vehicle;

TEST(AcousticChannel, IsReceivedAsFarAsTheWaterCarriesItWhereTheTransducersAre) {
  // At 25 kHz the sea absorbs 5 dB/km near the surface and 1.3 in its depths: no one is there.
  std::string vehicles = vehicle("a", "[0, 0, -20]");
  for (int i = 1; i <= 10; ++i)
    vehicles += vehicle("b" + std::to_string(i), "[" + std::to_string(15000 * i) + ", 0, -20]");
  TestWorld shallow(sea("{noise: {wind_mps: 10}}", vehicles));
  phone(shallow, "a").transducer().transmit(message(), 0ms);
  shallow.run_for(12);
  EXPECT_EQ(shallow.world.acoustics().flights(), 0);
  EXPECT_EQ(lost(shallow, "b1", SignalLoss::range), 1);

  // One that is down there is received from afar, as far as it can be by anyone on the way.
  TestWorld deep(sea("{noise: {wind_mps: 10}}", vehicles + vehicle("diver", "[0, 9000, -6000]")));
  phone(deep, "a").transducer().transmit(message(), 0ms);
  deep.run_for(12);
  EXPECT_GT(deep.world.acoustics().flights(), 1);
}

TEST(AcousticChannel, LooksForASignalOnlyAtThoseWhoAreNear) {
  for (const int fleet : {20, 160}) {
    std::string vehicles = vehicle("a", "[0, 0, -10]");
    for (int i = 1; i <= fleet; ++i)
      vehicles +=
          vehicle("b" + std::to_string(i), "[" + std::to_string(i <= 5 ? 1000 * i : 20000 + 1000 * i) + ", 0, -10]");
    TestWorld test(sea("{range_max_m: 6000}", vehicles));
    phone(test, "a").transducer().transmit(message(), 0ms);
    test.run_for(0.02);  // who is near whom is looked up once a second
    const std::int64_t before = test.world.acoustics().examined();
    Signal blip = message();
    blip.duration = 10ms;
    for (int i = 0; i < 10; ++i) phone(test, "a").transducer().transmit(blip, 100ms + i * 20ms);
    test.run_for(0.5);
    EXPECT_EQ(test.world.acoustics().examined() - before, 10 * 6) << fleet;  // itself and five
  }
}

TEST(AcousticChannel, WhatNoOneCouldNoticeIsLostInTheNoiseWhateverTheReceiverDoes) {
  TestWorld test(sea("{noise: {wind_mps: 10}}", vehicle("a", "[0, 0, -10]") + vehicle("b", "[150, 0, -10]")));
  phone(test, "b").transducer().transmit(message(), 0ms);
  phone(test, "a").transducer().transmit(message(110), 100ms);  // some 30 dB are lost; the noise has 78
  test.run_for(8);
  EXPECT_EQ(lost(test, "b", SignalLoss::noise), 1);
  EXPECT_EQ(lost(test, "b", SignalLoss::half_duplex), 0);
}

TEST(AcousticChannel, CountsMessagesForThoseTheyAreFor) {
  TestWorld test(sea("{range_max_m: 1000}", vehicle("a", "[0, 0, -10]") + vehicle("b", "[150, 0, -10]") +
                                                vehicle("c", "[0, 150, -10]") + vehicle("d", "[9000, 0, -10]") +
                                                vehicle("other", "[0, -150, -10]")));
  for (const char* name : {"a", "b", "c", "d"}) phone(test, name).transducer().set_address({"modems", name});
  phone(test, "other").transducer().set_address({"others", "b"});
  Signal to_b = message(), to_d = message(), to_all = message();
  to_b.to = {"modems", "b"}, to_d.to = {"modems", "d"}, to_all.to = {"modems", ""};
  for (int i = 0; i < 3; ++i) phone(test, "a").transducer().transmit(i == 0 ? to_b : i == 1 ? to_d : to_all, i * 4s);
  test.run_for(13);
  const auto understood = [&](const char* name) { return phone(test, name).transducer().counts().understood; };
  EXPECT_EQ(phone(test, "c").all().size(), 3u);  // all are received
  EXPECT_EQ(understood("a"), 0);
  EXPECT_EQ(understood("b"), 2);
  EXPECT_EQ(understood("c"), 1);
  EXPECT_EQ(understood("d"), 0);
  EXPECT_EQ(understood("other"), 0);
  EXPECT_EQ(lost(test, "d", SignalLoss::range), 2);
  for (const char* name : {"a", "b", "c", "other"}) EXPECT_EQ(lost(test, name, SignalLoss::range), 0) << name;
  // With another name it misses what is for that one, and keeps what it has missed.
  phone(test, "d").transducer().set_address({"modems", "e"});
  phone(test, "a").transducer().transmit(to_d, 14s);
  test.run_for(5);
  EXPECT_EQ(lost(test, "d", SignalLoss::range), 2);
}

TEST(AcousticChannel, ForgetsTheMessagesForThoseWhoHaveLeft) {
  TestWorld test(
      sea("{}", vehicle("a", "[0, 0, -10]") + vehicle("b", "[150, 0, -10]") + vehicle("c", "[0, 150, -10]")));
  for (const char* name : {"b", "c"}) phone(test, name).transducer().set_address({"modems", "x"});
  Signal to_x = message();
  to_x.to = {"modems", "x"};
  phone(test, "a").transducer().transmit(to_x, 0ms);
  test.run_for(5);
  const auto& acoustics = test.world.acoustics();
  test.world.editor().remove_vehicle("b");
  EXPECT_EQ(acoustics.messages_for({"modems", "x"}), 1) << "c has the same address";
  EXPECT_EQ(acoustics.counts_of_removed().understood, 1);
  test.world.editor().remove_vehicle("c");
  EXPECT_EQ(acoustics.messages_for({"modems", "x"}), 0);
  EXPECT_EQ(acoustics.counts_of_removed().understood, 2);
  EXPECT_EQ(acoustics.counts_of_removed().lost[static_cast<std::size_t>(SignalLoss::range)], 0);
}

TEST(AcousticChannel, WhatHasNotBegunCanBeCalledBack) {
  TestWorld test(sea("{}", vehicle("a", "[0, 0, -10]") + vehicle("b", "[150, 0, -10]")));
  phone(test, "a").transducer().transmit(message(), 0ms);
  phone(test, "a").transducer().transmit(message(), 4s);
  test.run_for(1);
  phone(test, "a").transducer().cancel_pending();
  EXPECT_EQ(phone(test, "a").transducer().busy_until(), 3200ms);
  test.run_for(8);
  EXPECT_EQ(phone(test, "b").all().size(), 1u);
  EXPECT_EQ(phone(test, "a").transducer().counts().sent, 1);
  EXPECT_EQ(phone(test, "a").transducer().counts().unsent, 0);
}

/// c is as loud at b as a was: it is understood, since a has fallen silent.
TEST(AcousticChannel, TheSoundOfASenderStopsWithItsPower) {
  for (const char* how : {"silent", "removed", "works"}) {
    TestWorld test(
        sea("{}", vehicle("a", "[-750, 0, -10]") + vehicle("b", "[0, 0, -10]") + vehicle("c", "[750, 0, -10]")));
    phone(test, "a").transducer().transmit(message(), 0ms);
    phone(test, "c").transducer().transmit(message(), 2s);
    test.run_for(1);
    if (std::string(how) == "silent") test.world.editor().set_fault("a/phone", {.kind = sim::FaultKind::silent});
    if (std::string(how) == "removed") test.world.editor().remove_vehicle("a");
    test.run_for(7);
    const bool stops = std::string(how) != "works";
    EXPECT_EQ(lost(test, "b", SignalLoss::sender_off), 0) << "a stronger one took over";
    EXPECT_EQ(lost(test, "b", SignalLoss::captured), stops) << how;
    EXPECT_EQ(phone(test, "b").transducer().counts().understood, stops) << how;
  }
}

TEST(AcousticChannel, AModemThatSendsReceivesNothing) {
  TestWorld test(sea("{}", vehicle("a", "[0, 0, -10]") + vehicle("b", "[150, 0, -10]")));
  // a's message is at b from 0.1 to 3.3 s; b sends from 3.15 s on, when a has nearly ended.
  phone(test, "a").transducer().transmit(message(), 0ms);
  phone(test, "b").transducer().transmit(message(), 3150ms);
  test.run_for(8);
  ASSERT_EQ(phone(test, "b").all().size(), 1u);
  EXPECT_EQ(phone(test, "b").all()[0].loss, SignalLoss::half_duplex);
  ASSERT_EQ(phone(test, "a").all().size(), 1u);  // a had ended when b's came
  EXPECT_TRUE(phone(test, "a").all()[0].understood());
}

TEST(AcousticChannel, ASignalThatComesWhileTheReceiverSendsIsLost) {
  TestWorld test(sea("{}", vehicle("a", "[0, 0, -10]") + vehicle("b", "[150, 0, -10]")));
  phone(test, "b").transducer().transmit(message(), 0ms);
  phone(test, "a").transducer().transmit(message(), 3050ms);  // at b from 3.15 s; b ends at 3.2 s
  test.run_for(8);
  ASSERT_EQ(phone(test, "b").all().size(), 1u);
  EXPECT_EQ(phone(test, "b").all()[0].loss, SignalLoss::half_duplex);
}

TEST(AcousticChannel, TwoSignalsOfOneStrengthDestroyEachOther) {
  TestWorld test(
      sea("{}", vehicle("a", "[-750, 0, -10]") + vehicle("b", "[0, 0, -10]") + vehicle("c", "[750, 0, -10]")));
  phone(test, "a").transducer().transmit(message(), 0ms);
  phone(test, "c").transducer().transmit(message(), 100ms);
  test.run_for(8);
  ASSERT_EQ(phone(test, "b").all().size(), 2u);
  EXPECT_EQ(phone(test, "b").all()[0].loss, SignalLoss::interference);
  EXPECT_EQ(phone(test, "b").all()[1].loss, SignalLoss::busy);
}

TEST(AcousticChannel, AReceiverThatDistinguishesCodesTakesOneOfTwoSignals) {
  TestWorld test(sea("{}", vehicle("a", "[-750, 0, -10]") +
                               vehicle("b", "[0, 0, -10]", ", receiver: {protection_dB: -20}") +
                               vehicle("c", "[750, 0, -10]")));
  phone(test, "a").transducer().transmit(message(), 0ms);
  phone(test, "c").transducer().transmit(message(), 100ms);
  test.run_for(8);
  ASSERT_EQ(phone(test, "b").all().size(), 2u);
  // At 0 dB in the band Eb/N0 is 17 dB, which 256 bits of FSK pass; so spread spectrum wins.  The second finds the
  // receiver busy.
  EXPECT_TRUE(phone(test, "b").all()[0].understood());
  EXPECT_EQ(phone(test, "b").all()[1].loss, SignalLoss::busy);
  EXPECT_NEAR(phone(test, "b").all()[0].sinr.dB(), 0, 0.01);
  Signal fast = message();
  fast.bit_rate_bps = 4000;
  phone(test, "a").transducer().transmit(fast, 8s);
  phone(test, "c").transducer().transmit(fast, 8100ms);
  test.run_for(8);
  ASSERT_EQ(phone(test, "b").all().size(), 4u);
  EXPECT_EQ(phone(test, "b").all()[2].loss, SignalLoss::interference);
  EXPECT_EQ(phone(test, "b").all()[3].loss, SignalLoss::busy);
}

TEST(AcousticChannel, AMuchStrongerSignalTakesTheReceiverOver) {
  TestWorld test(
      sea("{}", vehicle("a", "[-1500, 0, -10]") + vehicle("b", "[0, 0, -10]") + vehicle("c", "[150, 0, -10]")));
  phone(test, "a").transducer().transmit(message(), 0ms);     // at b from 1 s
  phone(test, "c").transducer().transmit(message(), 1200ms);  // at b from 1.3 s, 15 dB and absorption stronger
  test.run_for(8);
  ASSERT_EQ(phone(test, "b").all().size(), 2u);
  EXPECT_EQ(phone(test, "b").all()[0].source, "a/phone");
  EXPECT_EQ(phone(test, "b").all()[0].loss, SignalLoss::captured);
  EXPECT_TRUE(phone(test, "b").all()[1].understood());
}

}  // namespace
