// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/signal_receiver.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace std::chrono_literals;
using sim::Decibels;
using sim::PowerRatio;
using sim::SignalLoss;
using sim::SignalReceiver;
using sim::TakenSignal;
using sim::to_power;

constexpr SignalReceiver::Rules rules{6, 6};

/// Of one second, in noise of 0 dB.
TakenSignal signal(int flight, double level_dB, sim::Time started = 0s) {
  TakenSignal taken;
  taken.sound = {{flight}, 25000, 4000, to_power(Decibels{level_dB}), started + 1s};
  taken.noise = PowerRatio{1};
  taken.bit_rate_bps = 4000;  // Eb/N0 is the SNR
  taken.bits = 100;
  taken.started = started;
  taken.ended = started + 1s;
  return taken;
}

SignalLoss arrive(SignalReceiver& receiver, const TakenSignal& taken, sim::FlightId& displaced) {
  receiver.begin(taken.sound, taken.started);
  return receiver.take(taken, rules, displaced);
}

SignalLoss arrive(SignalReceiver& receiver, const TakenSignal& taken) {
  sim::FlightId displaced;
  return arrive(receiver, taken, displaced);
}

/// Of 100 bits of binary FSK.
double success(double snr_dB, double bits = 100) {
  return std::pow(1 - 0.5 * std::exp(-std::pow(10, snr_dB / 10) / 2), bits);
}

TEST(SignalReceiver, AloneASignalComesThroughByItsBitErrors) {
  SignalReceiver receiver;
  ASSERT_EQ(arrive(receiver, signal(1, 10)), SignalLoss::none);
  SignalReceiver::Outcome outcome;
  ASSERT_TRUE(receiver.end({1}, 1s, outcome));
  EXPECT_NEAR(outcome.success, success(10), 1e-12);
  EXPECT_NEAR(outcome.success_alone, success(10), 1e-12);
  EXPECT_NEAR(to_decibels(outcome.worst_sinr).dB(), 10, 1e-12);
  EXPECT_FALSE(receiver.taking());
}

/// However many sounds there are, and in which order they came: just where the sum of all says so.
TEST(SignalReceiver, NoticesASignalThatStandsOutAmongAllOthersTogether) {
  for (const int others : {1, 7, 8, 9, 40}) {
    for (const double over_dB : {0.01, -0.01}) {
      SignalReceiver receiver;
      double sum = 1;  // the noise
      for (int i = 0; i < others; ++i) {
        TakenSignal sound = signal(i, 0);
        sound.sound.power = PowerRatio{0.5 + i % 3};
        sum += sound.sound.power.linear();
        receiver.begin(sound.sound, 0s);
      }
      const TakenSignal strong = signal(others, 6 + 10 * std::log10(sum) + over_dB);
      EXPECT_EQ(arrive(receiver, strong), over_dB > 0 ? SignalLoss::none : SignalLoss::interference) << others;
    }
  }
}

TEST(SignalReceiver, BelowItsThresholdItNoticesNothing) {
  SignalReceiver receiver;
  EXPECT_EQ(arrive(receiver, signal(1, 5.9)), SignalLoss::noise);
  EXPECT_FALSE(receiver.taking());
}

TEST(SignalReceiver, AnOverlapCountsForTheBitsThatItHits) {
  SignalReceiver receiver;
  ASSERT_EQ(arrive(receiver, signal(1, 12)), SignalLoss::none);
  // From 0.75 s on another of 8 dB is there: the last quarter of the bits has 12 dB against 10 log10(1 + 10^0.8).
  EXPECT_EQ(arrive(receiver, signal(2, 8, 750ms)), SignalLoss::busy);
  SignalReceiver::Outcome outcome;
  ASSERT_TRUE(receiver.end({1}, 1s, outcome));
  const double sinr_dB = 12 - 10 * std::log10(1 + std::pow(10, 0.8));
  EXPECT_NEAR(outcome.success, success(12, 75) * success(sinr_dB, 25), 1e-12);
  EXPECT_NEAR(outcome.success_alone, success(12), 1e-12);
  EXPECT_NEAR(to_decibels(outcome.worst_sinr).dB(), sinr_dB, 1e-9);
}

TEST(SignalReceiver, AnInterferenceThatEndsInTheMiddleDoesNoMoreHarm) {
  SignalReceiver receiver;
  receiver.begin({{2}, 25000, 4000, to_power(Decibels{4}), 400ms}, 0s);
  ASSERT_EQ(arrive(receiver, signal(1, 14)), SignalLoss::none);
  SignalReceiver::Outcome outcome;
  EXPECT_FALSE(receiver.end({2}, 400ms, outcome));
  ASSERT_TRUE(receiver.end({1}, 1s, outcome));
  const double sinr_dB = 14 - 10 * std::log10(1 + std::pow(10, 0.4));
  EXPECT_NEAR(outcome.success, success(sinr_dB, 40) * success(14, 60), 1e-12);
}

TEST(SignalReceiver, OnlyWhatFallsIntoTheBandDisturbs) {
  for (const auto& [centre_Hz, share] : {std::pair{25000.0, 1.0}, {27000.0, 0.5}, {29000.0, 0.0}, {40000.0, 0.0}}) {
    SignalReceiver receiver;
    ASSERT_EQ(arrive(receiver, signal(1, 20)), SignalLoss::none);
    receiver.begin({{2}, centre_Hz, 4000, to_power(Decibels{15}), 1s}, 0s);
    SignalReceiver::Outcome outcome;
    ASSERT_TRUE(receiver.end({1}, 1s, outcome));
    EXPECT_NEAR(to_decibels(outcome.worst_sinr).dB(), 20 - 10 * std::log10(1 + share * std::pow(10, 1.5)), 1e-9);
  }
}

/// Spread over 100 times its bits a signal stands noise as loud as itself, but no other message.
TEST(SignalReceiver, AnotherMessageIsNoNoiseWhereItIsNotMuchWeaker) {
  for (const bool message : {true, false}) {
    for (const double other_dB : {20.0, 13.9, 14.1}) {
      SignalReceiver receiver;
      TakenSignal taken = signal(1, 20);
      taken.bit_rate_bps = 40;
      taken.protection = to_power(Decibels{6});
      ASSERT_EQ(arrive(receiver, taken), SignalLoss::none);
      receiver.begin({{2}, 25000, 4000, to_power(Decibels{other_dB}), 1200ms, message}, 900ms);
      SignalReceiver::Outcome outcome;
      ASSERT_TRUE(receiver.end({1}, 1s, outcome));
      // 10 of the 100 bits are guessed; as noise it leaves at least 19 dB.
      const bool destroyed = message && other_dB > 14;
      EXPECT_NEAR(outcome.success, destroyed ? std::pow(0.5, 10) : 1, 1e-6) << other_dB;
      EXPECT_NEAR(outcome.success_alone, 1, 1e-6);
    }
  }
}

TEST(SignalReceiver, ASoundThatStopsDisturbsNoLongerAndIsNotUnderstood) {
  SignalReceiver receiver;
  ASSERT_EQ(arrive(receiver, signal(1, 14)), SignalLoss::none);
  receiver.begin({{2}, 25000, 4000, to_power(Decibels{4}), 1s}, 0s);
  receiver.silence({2}, 250ms);
  SignalReceiver::Outcome outcome;
  ASSERT_TRUE(receiver.end({1}, 1s, outcome));
  const double sinr_dB = 14 - 10 * std::log10(1 + std::pow(10, 0.4));
  EXPECT_NEAR(outcome.success, success(sinr_dB, 25) * success(14, 75), 1e-12);

  SignalReceiver cut;
  ASSERT_EQ(arrive(cut, signal(4, 14)), SignalLoss::none);
  cut.silence({4}, 500ms);
  ASSERT_TRUE(cut.end({4}, 1s, outcome));
  EXPECT_LT(outcome.success, std::pow(0.5, 49));
}

TEST(SignalReceiver, ASignalIsCapturedByOneThatIsStrongerByTheRule) {
  for (const double level_dB : {25.9, 26.1}) {
    SignalReceiver receiver;
    ASSERT_EQ(arrive(receiver, signal(1, 20)), SignalLoss::none);
    sim::FlightId displaced;
    const SignalLoss loss = arrive(receiver, signal(2, level_dB, 500ms), displaced);
    EXPECT_EQ(loss, level_dB > 26 ? SignalLoss::none : SignalLoss::busy);
    EXPECT_EQ(displaced.number, level_dB > 26 ? 1 : -1);
  }
}

TEST(SignalReceiver, EchoesThatComeTooLateDisturbAsNoiseDoes) {
  SignalReceiver receiver;
  TakenSignal late = signal(1, 20);
  late.disturbing = PowerRatio{99};
  EXPECT_EQ(arrive(receiver, late), SignalLoss::noise);  // 20 dB against 20 dB
}

TEST(SignalReceiver, NoiseThatBeginsInTheMiddleCountsFromThenOn) {
  SignalReceiver receiver;
  ASSERT_EQ(arrive(receiver, signal(1, 14)), SignalLoss::none);
  receiver.set_noise({1}, PowerRatio{10}, 250ms);
  SignalReceiver::Outcome outcome;
  ASSERT_TRUE(receiver.end({1}, 1s, outcome));
  EXPECT_NEAR(outcome.success, success(14, 25) * success(4, 75), 1e-12);
}

TEST(SignalReceiver, WhatIsDroppedIsNotTakenAnyMore) {
  SignalReceiver receiver;
  ASSERT_EQ(arrive(receiver, signal(1, 20)), SignalLoss::none);
  EXPECT_EQ(receiver.drop(), sim::FlightId{1});
  EXPECT_FALSE(receiver.drop().valid());
  SignalReceiver::Outcome outcome;
  EXPECT_FALSE(receiver.end({1}, 1s, outcome));
}

}  // namespace
namespace {
TakenSignal in_band(int flight, double centre_Hz, double level_dB, sim::Time started = 0s) {
  TakenSignal taken = signal(flight, level_dB, started);
  taken.sound.centre_Hz = centre_Hz;
  return taken;
}

TEST(SignalReceiver, TakesSignalsInBandsApartSideBySide) {
  SignalReceiver receiver;
  ASSERT_EQ(arrive(receiver, in_band(1, 20000, 10)), SignalLoss::none);
  ASSERT_EQ(arrive(receiver, in_band(2, 24000, 12, 500ms)), SignalLoss::none);
  SignalReceiver::Outcome outcome;
  ASSERT_TRUE(receiver.end({1}, 1s, outcome));
  EXPECT_NEAR(outcome.success, success(10), 1e-12);
  ASSERT_TRUE(receiver.end({2}, 1500ms, outcome));
  EXPECT_NEAR(outcome.success, success(12), 1e-12);
}

TEST(SignalReceiver, ASignalTakesOneBandOverAndNotTwo) {
  SignalReceiver receiver;
  ASSERT_EQ(arrive(receiver, in_band(1, 20000, 10)), SignalLoss::none);
  ASSERT_EQ(arrive(receiver, in_band(2, 24000, 10)), SignalLoss::none);
  sim::FlightId displaced;
  EXPECT_EQ(arrive(receiver, in_band(3, 22000, 30, 100ms), displaced), SignalLoss::busy);
  EXPECT_EQ(displaced.number, -1);
  EXPECT_EQ(arrive(receiver, in_band(4, 18000, 30, 200ms), displaced), SignalLoss::none);
  EXPECT_EQ(displaced.number, 1);
}

TEST(SignalReceiver, DropsAllThatItTakes) {
  SignalReceiver receiver;
  ASSERT_EQ(arrive(receiver, in_band(1, 20000, 10)), SignalLoss::none);
  ASSERT_EQ(arrive(receiver, in_band(2, 24000, 10)), SignalLoss::none);
  EXPECT_EQ(receiver.drop().number + receiver.drop().number, 3);
  EXPECT_FALSE(receiver.taking());
}
}  // namespace
