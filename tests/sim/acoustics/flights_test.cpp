// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/flights.hpp"

#include <gtest/gtest.h>

#include "tests/sim/acoustics/sound_objects.hpp"

namespace {

using sim::FlightId;

TEST(Flights, TheSumOfTheirHashesIsKeptUpToDate) {
  test::SoundObjects sound;
  const sim::TransmissionId transmission = sound.transmit(test::AcousticProbe::tone());
  const FlightId first = sound.fly(transmission), second = sound.fly(transmission);
  sound.flights[second].travel_time_s = 0.1;
  sound.flights.update_hash(second);
  const std::uint64_t both = sound.hash_of_flights();
  sound.flights.discard_sum();
  EXPECT_EQ(sound.hash_of_flights(), both) << "computed again";
  sound.flights.remove(first);
  const std::uint64_t one = sound.hash_of_flights();
  EXPECT_NE(one, both);
  EXPECT_EQ(sound.fly(transmission), first);
  EXPECT_EQ(sound.hash_of_flights(), both);
  EXPECT_EQ(sound.flights.made(), 3);
}

TEST(Flights, TheChangesOfAThreadAreAddedLater) {
  test::SoundObjects sound;
  const FlightId id = sound.fly(sound.transmit(test::AcousticProbe::tone()));
  const std::uint64_t before = sound.hash_of_flights();
  sound.flights[id].present = true;
  std::uint64_t change = 0;
  sound.flights.update_hash(id, change);
  EXPECT_EQ(sound.hash_of_flights(), before);
  sound.flights.add_to_sum(change);
  const std::uint64_t after = sound.hash_of_flights();
  EXPECT_NE(after, before);
  sound.flights.discard_sum();
  EXPECT_EQ(sound.hash_of_flights(), after);
}

TEST(Flights, LoseTheirReceiverWhenItIsRemoved) {
  test::SoundObjects sound;
  const FlightId id = sound.fly(sound.transmit(test::AcousticProbe::tone()));
  EXPECT_EQ(sound.flights.receiver(id), &sound.b.transducer);
  sound.transducers.remove(sound.b.transducer);
  EXPECT_EQ(sound.flights.receiver(id), nullptr);
  sound.transducers.add(sound.b.transducer);
  EXPECT_EQ(sound.flights.receiver(id), nullptr) << "another one of the same number";
}

TEST(Flights, AreRestoredToTheirTransmissionAndReceiver) {
  test::SoundObjects sound;
  const sim::TransmissionId transmission = sound.transmit(test::AcousticProbe::tone());
  const FlightId id = sound.fly(transmission);
  const std::uint64_t hash = sound.hash_of_flights();
  sim::StateArchive saver = sim::StateArchive::saver();
  sound.flights.visit_items(saver, 1, sound.transmissions);
  const std::vector<std::byte> bytes = saver.take_bytes();
  sim::StateArchive restorer = sim::StateArchive::restorer(bytes);
  sound.flights.visit_items(restorer, 1, sound.transmissions);
  EXPECT_EQ(sound.flights.receiver(id), &sound.b.transducer);
  EXPECT_EQ(sound.transmissions[transmission].flights, std::vector<FlightId>{id});
  EXPECT_EQ(sound.hash_of_flights(), hash);
}

}  // namespace
