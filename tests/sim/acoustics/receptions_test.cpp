// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/receptions.hpp"

#include <gtest/gtest.h>

#include "tests/sim/acoustics/sound_objects.hpp"

namespace {

using namespace std::chrono_literals;
using sim::AcousticEvent;
using sim::ArrivalEffects;
using sim::FlightId;
using sim::SignalLoss;
using sim::Time;

constexpr Time arrival{66'667};  // 100 m at 1500 m/s

/// A tone of 10 ms from a to b.
struct Tone : test::SoundObjects {
  using SoundObjects::SoundObjects;
  sim::TransmissionId transmission = transmit(test::AcousticProbe::tone());
  FlightId id = fly(transmission);
  ArrivalEffects handle(AcousticEvent kind, Time due) {
    ArrivalEffects effects;
    receptions.handle(id, kind, due, effects);
    flights.add_to_sum(effects.sum);
    return effects;
  }
  ArrivalEffects start() {
    handle(AcousticEvent::near, 65ms);
    return handle(AcousticEvent::start, arrival);
  }
};

TEST(Receptions, ArrivalIsPredictedByTheSpeedOfSound) {
  Tone tone;
  const ArrivalEffects effects = tone.handle(AcousticEvent::near, 65ms);
  EXPECT_NEAR(tone.flights[tone.id].travel_time_s, 100.0 / 1500, 1e-9);
  ASSERT_EQ(effects.count, 1);
  EXPECT_EQ(effects.events[0].kind, AcousticEvent::start);
  EXPECT_EQ(effects.events[0].at, arrival);
}

TEST(Receptions, AReceiverLocksOnToASignalAndGetsItAtItsEnd) {
  Tone tone;
  const ArrivalEffects effects = tone.start();
  ASSERT_EQ(effects.count, 1);
  EXPECT_EQ(effects.events[0].kind, AcousticEvent::end);
  EXPECT_EQ(effects.events[0].at, arrival + 10ms);
  const sim::Flight& flight = tone.flights[tone.id];
  EXPECT_TRUE(flight.listened && flight.present && flight.detected);
  EXPECT_TRUE(tone.b.transducer.receiving());
  const sim::Decibels sinr = tone.receptions.end(tone.id, tone.b.transducer);
  EXPECT_EQ(flight.loss, SignalLoss::none);
  EXPECT_NEAR(sinr.dB(), flight.snr.dB(), 1e-9) << "no interferer";
  EXPECT_FALSE(tone.b.transducer.receiving());
  ASSERT_TRUE(tone.receptions.notifies(flight, tone.b.transducer));
  tone.receptions.notify(tone.b.transducer, flight, sinr);
  ASSERT_EQ(tone.b.all.size(), 1u);
  EXPECT_NEAR(tone.b.all[0].level_dB, 180 - 40, 1e-9);
}

TEST(Receptions, AFlightToARemovedReceiverEndsAtItsStart) {
  Tone tone;
  tone.transducers.remove(tone.b.transducer);
  const ArrivalEffects effects = tone.handle(AcousticEvent::start, arrival);
  EXPECT_TRUE(effects.ended);
  EXPECT_EQ(effects.count, 0);
  tone.transducers.add(tone.b.transducer);
}

TEST(Receptions, BeyondTheMaximumRangeAFlightEndsAtItsStart) {
  Tone tone(", range_max_m: 50");
  tone.flights[tone.id].addressed = true;
  EXPECT_TRUE(tone.start().ended);
  EXPECT_EQ(tone.flights[tone.id].loss, SignalLoss::range);
  EXPECT_EQ(tone.b.transducer.counts().lost[static_cast<std::size_t>(SignalLoss::range)], 1);
}

TEST(Receptions, AbortedOnesKeepTheirCause) {
  Tone tone;
  tone.start();
  tone.receptions.abort_all(tone.b.transducer, SignalLoss::half_duplex);
  EXPECT_FALSE(tone.b.transducer.receiving());
  tone.receptions.end(tone.id, tone.b.transducer);
  EXPECT_EQ(tone.flights[tone.id].loss, SignalLoss::half_duplex);
}

TEST(Receptions, ATruncatedSignalFallsSilentInProportionToItsDuration) {
  Tone tone;
  tone.start();
  tone.transmissions.truncate(tone.transmission, SignalLoss::sender_off, 4ms);
  const sim::Transmission& transmission = tone.transmissions[tone.transmission];
  EXPECT_EQ(tone.receptions.silent_from(tone.id, transmission, 0s), arrival + 4ms);
  EXPECT_EQ(tone.receptions.silent_from(tone.id, transmission, 72ms), Time{72ms}) << "not in the past";
  EXPECT_FALSE(tone.receptions.silent_from(tone.id, transmission, 1s));
  tone.receptions.silence(tone.id, arrival + 4ms);
  tone.receptions.end(tone.id, tone.b.transducer);
  EXPECT_EQ(tone.flights[tone.id].loss, SignalLoss::sender_off);
}

TEST(Receptions, NoiseThatStartsLowersTheRatioOfASignalBeingReceived) {
  Tone tone;
  tone.start();
  sim::ContinuousSound jammer(sim::Decibels{190}, 25000, 4000, tone.site("a/jammer"));
  tone.sonar.add(jammer);
  tone.receptions.update_noise();
  const sim::Decibels sinr = tone.receptions.end(tone.id, tone.b.transducer);
  EXPECT_NEAR(sinr.dB(), -10, 0.1);  // 180 dB in a noise of 190 dB, at the same distance
}

}  // namespace
