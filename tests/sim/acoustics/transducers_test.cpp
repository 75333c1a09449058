// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/transducers.hpp"

#include <gtest/gtest.h>

#include "tests/sim/acoustics/sound_objects.hpp"

namespace {

TEST(Transducers, ANewOneOfTheSameNumberIsNotTheRemovedOne) {
  test::SoundObjects sound;
  const sim::TransducerRef before = sound.a.transducer.ref();
  EXPECT_EQ(before.number, 0);
  EXPECT_EQ(sound.transducers.find(before), &sound.a.transducer);
  sound.transducers.remove(sound.a.transducer);
  EXPECT_EQ(sound.transducers.find(before), nullptr);
  EXPECT_EQ(sound.transducers.all()[0], nullptr);
  sound.transducers.add(sound.a.transducer);
  EXPECT_EQ(sound.a.transducer.number(), 0);
  EXPECT_EQ(sound.transducers.find(before), nullptr) << "another registration";
  EXPECT_EQ(sound.transducers.find(sound.a.transducer.ref()), &sound.a.transducer);
  EXPECT_EQ(sound.transducers.find({}), nullptr);
}

TEST(Transducers, AnAddressIsThatOfSomeTransducerUntilItIsRemoved) {
  test::SoundObjects sound;
  sound.b.transducer.set_address({"modems", "b"});
  EXPECT_TRUE(sound.transducers.any_has({"modems", "b"}));
  EXPECT_FALSE(sound.transducers.any_has({"others", "b"}));
  sound.transducers.remove(sound.b.transducer);
  EXPECT_FALSE(sound.transducers.any_has({"modems", "b"}));
  sound.transducers.add(sound.b.transducer);
}

TEST(Transducers, TheCountsOfARemovedOneAreKept) {
  test::SoundObjects sound;
  const sim::FlightId id = sound.fly(sound.transmit(test::AcousticProbe::tone()));
  sound.flights[id].listened = sound.flights[id].addressed = true;
  sound.receptions.end(id, sound.b.transducer);
  sound.transducers.remove(sound.b.transducer);
  EXPECT_EQ(sound.transducers.counts_of_removed().understood, 1);
  EXPECT_EQ(sound.transducers.counts_of_removed().lost[0], 1) << "by SignalLoss::none";
  sound.transducers.add(sound.b.transducer);
}

}  // namespace
