// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/receiver_search.hpp"

#include <gtest/gtest.h>

#include "tests/sim/acoustics/sound_objects.hpp"

namespace {

using namespace std::chrono_literals;

TEST(ReceiverSearch, FindsTheOthersWithinTheRange) {
  test::SoundObjects sound;
  const sim::Signal tone = test::AcousticProbe::tone();
  const sim::Transmission& transmission = sound.transmissions[sound.transmit(tone)];
  const double range_m = sound.search.update_range(tone, 0s);
  EXPECT_GT(range_m, 100);
  EXPECT_EQ(sound.search.receivers(transmission, range_m), std::vector<sim::Transducer*>{&sound.b.transducer});
  EXPECT_EQ(sound.search.receivers(transmission, 101).size(), 1u);
  EXPECT_EQ(sound.search.receivers(transmission, 99).size(), 0u);
}

TEST(ReceiverSearch, ALouderSignalHasALongerRange) {
  test::SoundObjects sound;
  const double soft_m = sound.search.update_range(test::AcousticProbe::tone(150), 0s);
  const double loud_m = sound.search.update_range(test::AcousticProbe::tone(190), 0s);
  EXPECT_GT(loud_m, soft_m);
}

TEST(ReceiverSearch, ExaminesAllTransducersOnceASecond) {
  test::SoundObjects sound;
  const sim::Signal tone = test::AcousticProbe::tone();
  const auto examined_at = [&](sim::Time now) {
    const std::int64_t before = sound.search.examined();
    sound.search.update_range(tone, now);
    return sound.search.examined() - before;
  };
  EXPECT_EQ(examined_at(0s), 2 + 2) << "for their places and for the lowest level";
  EXPECT_EQ(examined_at(900ms), 0);
  EXPECT_EQ(examined_at(1100ms), 2) << "places";
  sound.search.discard_places();
  EXPECT_EQ(examined_at(1200ms), 2);
  sound.search.discard_all();
  EXPECT_EQ(examined_at(1300ms), 2 + 2);
}

}  // namespace
