// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/channel.hpp"

#include "sim/world/world_editor.hpp"
#include "tests/sim/acoustics/sea_of_hydrophones.hpp"

namespace {

using namespace std::chrono_literals;
using sim::Decibels;
using sim::Signal;
using sim::SignalLoss;
using test::Hydrophone;
using test::lost;
using test::message;
using test::phone;
using test::Received;
using test::sea;
using test::TestWorld;
using test::vehicle;

SHOAL_SENSOR("test_hydrophone", Hydrophone, void);

TEST(AcousticChannel, ASignalArrivesAfterDistanceBySpeedAndLastsItsDuration) {
  TestWorld test(sea("{}", vehicle("a", "[0, 0, -10]") + vehicle("b", "[750, 0, -10]")));
  phone(test, "a").transducer().transmit(message(), 5ms);
  test.run_for(4);
  ASSERT_EQ(phone(test, "b").all().size(), 1u);
  const Received& received = phone(test, "b").all()[0];
  EXPECT_TRUE(received.understood());
  EXPECT_EQ(received.source, "a/phone");
  EXPECT_EQ(received.sent, 5ms);
  EXPECT_EQ(received.started, 505ms);  // 750 m / 1500 m/s, inside of a step
  EXPECT_EQ(received.ended, 505ms + 3200ms);
  EXPECT_NEAR(received.travel_time_s, 0.5, 1e-9);
  EXPECT_EQ(received.closing_mps, 0);
}

TEST(AcousticChannel, LevelAndSnrAreThoseOfTheLinkBudget) {
  // The row acoustic_link of tests/fidelity/reference/closed_forms.csv.
  TestWorld test(sea("{spreading: {factor: 1.5}, absorption: {model: thorp}, noise: {shipping: 0.5, wind_mps: 5}}",
                     vehicle("a", "[0, 0, -10]") + vehicle("b", "[1500, 0, -10]")));
  phone(test, "a").transducer().transmit(message(), 0ms);
  test.run_for(5);
  ASSERT_EQ(phone(test, "b").all().size(), 1u);
  EXPECT_NEAR(phone(test, "b").all()[0].level.dB(), 185 - 56.79857654, 0.05);
  EXPECT_NEAR(phone(test, "b").all()[0].snr.dB(), 53.63274597, 0.1);
}

TEST(AcousticChannel, BothEndsMoveWhileASignalIsUnderWay) {
  // The receiver goes away with 3 m/s, the sender crosses with 2 m/s: |(600 + 3 s, 0)| = 1500 s after sending.
  TestWorld test(sea("{}", vehicle("a", "[0, 0, -10]", "", 2, 90) + vehicle("b", "[600, 0, -10]", "", 3, 0)));
  test.run_for(10);
  const double d_m = 600 + 3 * 10.0;
  const double y_m = -2 * 10.0;  // of b as a sees it when it sends
  phone(test, "a").transducer().transmit(message(), 10s);
  test.run_for(6);
  ASSERT_EQ(phone(test, "b").all().size(), 1u);
  const Received& received = phone(test, "b").all()[0];
  // (d + 3 s)^2 + y^2 = (1500 s)^2
  const double a = 1500.0 * 1500.0 - 9, b = 3 * d_m, c = d_m * d_m + y_m * y_m;
  const double s = (b + std::sqrt(b * b + a * c)) / a;
  EXPECT_NEAR(received.travel_time_s, s, 2e-9);
  const double length_m = 1500 * s;
  const double closing_mps = (-3 * (d_m + 3 * s) + 2 * y_m) / length_m;
  EXPECT_NEAR(received.closing_mps, closing_mps, 1e-9);
  EXPECT_NEAR(sim::to_seconds(received.ended - received.started),
              3.2 * (1500 - 2 * y_m / length_m) / (1500 - 3 * (d_m + 3 * s) / length_m), 2e-6);
}

TEST(AcousticChannel, WhoClosesInTooFastIsNotUnderstood) {
  for (const double limit_mps : {2.9, 3.1}) {
    const std::string keys = ", receiver: {doppler_limit_mps: " + std::to_string(limit_mps) + "}";
    TestWorld test(sea("{}", vehicle("a", "[0, 0, -10]", "", 3) + vehicle("b", "[600, 0, -10]", keys)));
    phone(test, "a").transducer().transmit(message(), 0ms);
    test.run_for(6);
    ASSERT_EQ(phone(test, "b").all().size(), 1u);
    EXPECT_EQ(phone(test, "b").all()[0].loss, limit_mps > 3 ? SignalLoss::none : SignalLoss::doppler);
    EXPECT_NEAR(phone(test, "b").all()[0].closing_mps, 3, 1e-9);
  }
}

TEST(AcousticChannel, OnlyWhoIsNearEnoughIsGivenASignal) {
  std::string vehicles = vehicle("a", "[0, 0, -10]");
  for (int i = 1; i <= 30; ++i)
    vehicles += vehicle("b" + std::to_string(i), "[" + std::to_string(1000 * i) + ", 0, -10]");
  TestWorld test(sea("{range_max_m: 5100}", vehicles));
  phone(test, "a").transducer().transmit(message(), 0ms);
  test.run_for(10);
  EXPECT_EQ(test.world.acoustics().flights(), 5);
  for (int i = 1; i <= 30; ++i) EXPECT_EQ(phone(test, "b" + std::to_string(i)).all().size(), i <= 5 ? 1u : 0u);
}

TEST(AcousticChannel, WorkOfASignalGrowsWithItsHearersAndNotWithTheFleet) {
  std::vector<std::int64_t> flights;
  for (const int fleet : {20, 80, 160}) {
    std::string vehicles = vehicle("a", "[0, 0, -10]");
    for (int i = 1; i <= fleet; ++i)
      vehicles += vehicle("b" + std::to_string(i), "[" + std::to_string(1000 * (i - fleet / 2) - 500) + ", 0, -10]");
    TestWorld test(sea("{range_max_m: 4100}", vehicles));
    phone(test, "a").transducer().transmit(message(), 0ms);
    test.run_for(10);
    flights.push_back(test.world.acoustics().flights());
  }
  EXPECT_EQ(flights, (std::vector<std::int64_t>{8, 8, 8}));  // 4 to each side
}

TEST(AcousticChannel, BeyondItsAudibleRangeASignalIsBelowTheNoise) {
  TestWorld test(sea("{absorption: {model: thorp}, noise: {wind_mps: 5}}", vehicle("a", "[0, 0, -10]")));
  const sim::Propagation& propagation = test.world.acoustics().propagation();
  const double range_m = propagation.audible_range_m(message(), Decibels{10});
  const Decibels level = message().source_level - propagation.transmission_loss({0, 0, -10}, {range_m, 0, -10}, 25000);
  EXPECT_LE(level.dB(), (propagation.ambient_level(25000, 4000) - Decibels{10}).dB());
  EXPECT_LT(range_m, 20000);
}

TEST(AcousticChannel, AnAnswerBeginsWhenTheListenerSaysSo) {
  TestWorld test(sea("{}", vehicle("a", "[0, 0, -10]") + vehicle("b", "[750, 0, -10]")));
  phone(test, "b").answer = [&](const sim::Reception& r) {
    Signal answer = r.signal;
    answer.kind = Signal::Kind::answer;
    phone(test, "b").transducer().transmit(answer, r.ended + 20ms);
  };
  Signal ping;
  ping.kind = Signal::Kind::ping;
  ping.duration = 10ms;
  phone(test, "a").transducer().transmit(ping, 3ms);
  test.run_for(2);
  ASSERT_EQ(phone(test, "a").all().size(), 1u);
  EXPECT_EQ(phone(test, "a").all()[0].started, 3ms + 500ms + 10ms + 20ms + 500ms);
}

TEST(AcousticChannel, WhoIsRemovedNeitherReceivesNorIsMissed) {
  TestWorld test(
      sea("{}", vehicle("a", "[0, 0, -10]") + vehicle("b", "[750, 0, -10]") + vehicle("c", "[0, 750, -10]")));
  phone(test, "a").transducer().transmit(message(), 0ms);
  phone(test, "b").transducer().transmit(message(), 100ms);  // not yet in the water when b goes
  test.run_for(0.05);
  test.world.editor().remove_vehicle("b");
  test.run_for(0.1);
  test.world.editor().remove_vehicle("a");
  test.run_for(6);
  // What a began is received; its end is missing.
  ASSERT_EQ(test.world.acoustics().flights(), 2);
  ASSERT_EQ(phone(test, "c").all().size(), 1u);
  EXPECT_FALSE(phone(test, "c").all()[0].understood());
  EXPECT_EQ(phone(test, "c").transducer().counts().lost[static_cast<std::size_t>(SignalLoss::sender_off)], 1);
}

TEST(AcousticChannel, WhoTakesThePlaceOfOneThatLeftDoesNotReceiveWhatWasForThatOne) {
  TestWorld test(sea("{}", vehicle("a", "[0, 0, -10]") + vehicle("b", "[750, 0, -10]")));
  phone(test, "a").transducer().transmit(message(), 0ms);
  test.run_for(0.1);
  const int number = phone(test, "b").transducer().number();
  test.world.editor().remove_vehicle("b");
  test.world.editor().add_vehicle(test.loaded.config.vehicles[1]);
  ASSERT_EQ(phone(test, "b").transducer().number(), number);
  test.run_for(6);
  EXPECT_TRUE(phone(test, "b").all().empty());
}

TEST(AcousticChannel, EchoesCarryASignalAroundAWall) {
  const std::string wall =
      "objects:\n  - {name: wall, fixed: true, position_m: [75, 0, -10], parts: [{shape: box, size_m: [1, 20, 8]}]}\n"
      "  - {name: bottom, fixed: true, position_m: [0, 0, -20], parts: [{shape: plane}]}\n";
  TestWorld test(sea("{multipath: {bottom: {loss_dB: 3}, surface_loss_dB: 1}}",
                     vehicle("a", "[0, 0, -10]") + vehicle("b", "[150, 0, -10]"), wall));
  phone(test, "a").transducer().transmit(message(), 0ms);
  test.run_for(5);
  ASSERT_EQ(phone(test, "b").all().size(), 1u);
  EXPECT_TRUE(phone(test, "b").all()[0].understood());
}

TEST(AcousticChannel, FadingDiffersFromSignalToSignalAndFromRunToRunOnlyBySeed) {
  const auto levels = [](int seed) {
    TestWorld test(
        sea("{fading: {type: log_normal, std_dB: 6}}", vehicle("a", "[0, 0, -10]") + vehicle("b", "[150, 0, -10]")) +
        "run: {seed: " + std::to_string(seed) + "}\n");
    for (int i = 0; i < 40; ++i) {
      phone(test, "a").transducer().transmit(message(), test.world.now());
      test.run_for(4);
    }
    std::vector<double> dB;
    for (const Received& received : phone(test, "b").all()) dB.push_back(received.level.dB());
    return dB;
  };
  const std::vector<double> one = levels(1);
  ASSERT_EQ(one.size(), 40u);
  EXPECT_EQ(one, levels(1));
  EXPECT_NE(one, levels(2));
  double mean = 0, square = 0;
  for (const double dB : one) mean += dB / 40;
  for (const double dB : one) square += (dB - mean) * (dB - mean) / 39;
  EXPECT_NEAR(std::sqrt(square), 6, 2.1);  // 3 sigma of the standard deviation of 40
}

TEST(AcousticChannel, WhatStandsBetweenBlocksASignal) {
  const std::string wall =
      "objects:\n  - {name: wall, fixed: true, position_m: [75, 0, -10], parts: [{shape: box, size_m: [1, 20, 20]}]}\n";
  const std::string both = vehicle("a", "[0, 0, -10]") + vehicle("b", "[150, 0, -10]");
  TestWorld blocked(sea("{}", both, wall));
  phone(blocked, "a").transducer().transmit(message(), 0ms);
  blocked.run_for(5);
  EXPECT_TRUE(phone(blocked, "b").all().empty());
  EXPECT_EQ(phone(blocked, "b").transducer().counts().lost[static_cast<std::size_t>(SignalLoss::blocked)], 1);

  TestWorld dimmed(sea("{occlusion_loss_dB: 20}", both, wall)), open(sea("{}", both));
  for (TestWorld* test : {&dimmed, &open}) {
    phone(*test, "a").transducer().transmit(message(), 0ms);
    test->run_for(5);
    ASSERT_EQ(phone(*test, "b").all().size(), 1u);
  }
  EXPECT_NEAR((phone(open, "b").all()[0].level - phone(dimmed, "b").all()[0].level).dB(), 20, 1e-9);
}

TEST(AcousticChannel, SoundGoesRoundWhatIsSmallerThanItsFresnelZone) {
  // Half way on 600 m at 25 kHz the zone has a radius of 3 m: of a ball of 0.5 m only the middle of nine rays knows.
  const std::string ball =
      "objects:\n  - {name: ball, fixed: true, position_m: [300, 0, -50], parts: [{shape: sphere, radius_m: 0.5}]}\n";
  const std::string both = vehicle("a", "[0, 0, -50]") + vehicle("b", "[600, 0, -50]");
  TestWorld behind(sea("{}", both, ball)), open(sea("{}", both));
  for (TestWorld* test : {&behind, &open}) {
    phone(*test, "a").transducer().transmit(message(), 0ms);
    test->run_for(5);
    ASSERT_EQ(phone(*test, "b").all().size(), 1u);
  }
  EXPECT_NEAR((phone(open, "b").all()[0].level - phone(behind, "b").all()[0].level).dB(), -20 * std::log10(8.0 / 9),
              1e-9);
}

TEST(AcousticChannel, ALinkCanBeMadeWorse) {
  TestWorld test(sea("{links: [{from: a, to: b, loss_probability: 1, both_ways: false}, {from: c, extra_loss_dB: 7}]}",
                     vehicle("a", "[0, 0, -10]") + vehicle("b", "[150, 0, -10]") + vehicle("c", "[0, 150, -10]")));
  phone(test, "a").transducer().transmit(message(), 0ms);
  phone(test, "b").transducer().transmit(message(), 5s);
  test.run_for(10);
  ASSERT_EQ(phone(test, "b").all().size(), 1u);
  EXPECT_EQ(phone(test, "b").all()[0].loss, SignalLoss::link);
  ASSERT_EQ(phone(test, "a").all().size(), 1u);
  EXPECT_TRUE(phone(test, "a").all()[0].understood());
  ASSERT_EQ(phone(test, "c").all().size(), 2u);
  EXPECT_TRUE(phone(test, "c").all()[0].understood());
  EXPECT_NEAR((phone(test, "a").all()[0].level - phone(test, "c").all()[1].level).dB(),
              7 + 10 * 1.5 * std::log10(std::sqrt(2.0)), 0.5);
}

TEST(AcousticChannel, NoOneReceivesWhoSendsOutOfTheWater) {
  TestWorld test(sea("{}", vehicle("a", "[0, 0, 1]") + vehicle("b", "[150, 0, -10]")));
  phone(test, "a").transducer().transmit(message(), 0ms);
  test.run_for(5);
  EXPECT_TRUE(phone(test, "b").all().empty());
  EXPECT_EQ(phone(test, "a").transducer().counts().unsent, 1);
  EXPECT_EQ(phone(test, "a").transducer().counts().sent, 0);
}

TEST(AcousticChannel, WhoLeavesTheWaterWhileSendingIsNotUnderstood) {
  TestWorld test(sea("{}", vehicle("a", "[0, 0, -10]") + vehicle("b", "[150, 0, -10]")));
  phone(test, "a").transducer().transmit(message(), 0ms);
  test.run_for(1);
  test.world.editor().move_vehicle("a", sim::make_pose({0, 0, 5}, {0, 0, 0}));
  test.run_for(5);
  EXPECT_EQ(phone(test, "b").transducer().counts().understood, 0);
  EXPECT_EQ(phone(test, "b").transducer().counts().lost[static_cast<std::size_t>(SignalLoss::out_of_water)], 1);
}

TEST(AcousticChannel, WhoIsOutOfTheWaterForAWhileWhileSendingOrTakingIsNotUnderstood) {
  for (const char* who : {"a", "b"}) {
    TestWorld test(sea("{}", vehicle("a", "[0, 0, -10]") + vehicle("b", "[150, 0, -10]")));
    const sim::Pose back = test.world.find_vehicle(who)->X_WV();
    phone(test, "a").transducer().transmit(message(), 0ms);
    test.run_for(1);
    test.world.editor().move_vehicle(who, sim::make_pose({0, 50, 5}, {0, 0, 0}));
    test.run_for(0.5);
    test.world.editor().move_vehicle(who, back);
    test.run_for(5);
    EXPECT_EQ(phone(test, "b").transducer().counts().understood, 0) << who;
    EXPECT_EQ(phone(test, "b").transducer().counts().lost[static_cast<std::size_t>(SignalLoss::out_of_water)], 1);
    // A receiver in the water is commanded that something came, one that was out itself is not.
    EXPECT_EQ(phone(test, "b").all().size(), std::string(who) == "a" ? 1u : 0u);
  }
}

TEST(AcousticChannel, WhoHasLostItsPowerIsNotifiedNothing) {
  TestWorld test(sea("{}", vehicle("a", "[0, 0, -10]") + vehicle("b", "[150, 0, -10]")));
  Signal blip = message();
  blip.duration = 50ms;
  phone(test, "a").transducer().transmit(blip, 0ms);
  phone(test, "b").transducer().transmit(blip, 60ms);  // it sends when the sound of a comes
  test.run_for(0.12);
  test.world.editor().set_fault("b/phone", {.kind = sim::FaultKind::silent});
  test.run_for(1);
  EXPECT_EQ(lost(test, "b", SignalLoss::half_duplex), 1);
  EXPECT_TRUE(phone(test, "b").all().empty());
}

TEST(AcousticChannel, ShortSignalsOneAfterTheOtherAllComeThrough) {
  TestWorld test(sea("{}", vehicle("a", "[0, 0, -10]") + vehicle("b", "[300, 0, -10]")));
  Signal blip = message();
  blip.duration = 2ms;
  blip.bits = 8;
  blip.bit_rate_bps = 4000;
  for (int i = 0; i < 20; ++i) phone(test, "a").transducer().transmit(blip, i * 2ms);
  test.run_for(1);
  EXPECT_EQ(phone(test, "b").transducer().counts().understood, 20);
}

TEST(AcousticChannel, BeyondTheLargestRangeNothingIsReceived) {
  TestWorld test(sea("{range_max_m: 500}",
                     vehicle("a", "[0, 0, -10]") + vehicle("b", "[499, 0, -10]") + vehicle("c", "[0, 501, -10]")));
  phone(test, "a").transducer().transmit(message(), 0ms);
  test.run_for(5);
  EXPECT_EQ(phone(test, "b").all().size(), 1u);
  EXPECT_TRUE(phone(test, "c").all().empty());
}

TEST(AcousticChannel, InFreshWaterSoundIsReceivedFarther) {
  // Francois and Garrison: at 100 kHz 33 dB/km in the sea, 3 in fresh water; at 6 km both noise limits are far apart.
  const auto received = [](double salinity_psu) {
    std::string world = sea("{}", vehicle("a", "[0, 0, -10]") + vehicle("b", "[6000, 0, -10]"));
    const std::string water = "sound_speed_mps: 1500";
    world.replace(world.find(water), water.size(), water + ", salinity_psu: " + std::to_string(salinity_psu));
    TestWorld test(world);
    Signal high = message();
    high.centre_Hz = 100000;
    phone(test, "a").transducer().transmit(high, 0ms);
    test.run_for(9);
    return phone(test, "b").transducer().counts().understood;
  };
  EXPECT_EQ(received(0), 1);
  EXPECT_EQ(received(35), 0);
}

TEST(AcousticChannel, WhereOnlyAnEchoComesItComesLater) {
  const std::string wall =
      "objects:\n  - {name: wall, fixed: true, position_m: [75, 0, -10], parts: [{shape: box, size_m: [1, 20, 8]}]}\n";
  TestWorld test(sea("{multipath: {max_bounces: 1, surface_loss_dB: 1, water_depth_m: 1000}}",
                     vehicle("a", "[0, 0, -10]") + vehicle("b", "[150, 0, -10]"), wall));
  phone(test, "a").transducer().transmit(message(), 0ms);
  test.run_for(5);
  ASSERT_EQ(phone(test, "b").all().size(), 1u);
  EXPECT_NEAR(phone(test, "b").all()[0].travel_time_s, std::hypot(150, 20) / 1500, 2e-6);  // by the surface
}

TEST(AcousticChannel, AWorldWithoutWaterCannotCarrySound) {
  const std::string rest =
      ": device 'phone': a device of type 'test_hydrophone' needs water to carry its sound: the world has no "
      "'medium: {water: ...}'";
  // Every one is notified of, not the first alone.
  EXPECT_EQ(
      test::error_of_world("shoal: 1\nname: dry\nvehicles:\n" + vehicle("a", "[0, 0, 0]") + vehicle("b", "[9, 0, 0]")),
      "worlds/test.yaml:13:11: vehicle 'a'" + rest + "\nworlds/test.yaml:23:11: vehicle 'b'" + rest);
  // Of many of one kind one stands for all.
  EXPECT_EQ(test::error_of_world("shoal: 1\nname: dry\nvehicles:\n" + vehicle("a", "[0, 0, 0]") +
                                 "    count: 3\n    placement: {pattern: grid, spacing_m: 5}\n"),
            "worlds/test.yaml:13:11: vehicle 'a1'" + rest);
}

}  // namespace
