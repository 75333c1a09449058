// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/transmissions.hpp"

#include <gtest/gtest.h>

#include "tests/sim/acoustics/sound_objects.hpp"

namespace {

using namespace std::chrono_literals;
using sim::TransmissionId;

TEST(Transmissions, StayUntilTheirLastUser) {
  test::SoundObjects sound;
  const TransmissionId id = sound.transmit(test::AcousticProbe::tone());
  sound.fly(id);
  EXPECT_EQ(sound.transmissions[id].users, 3) << "start, end, flight";
  EXPECT_EQ(sound.transmissions[id].source, "a/probe");
  for (int i = 0; i < 2; ++i) sound.transmissions.release(id);
  EXPECT_EQ(sound.transmissions[id].source, "a/probe");
  sound.transmissions.release(id);
  EXPECT_EQ(sound.transmissions[id].source, "");
  EXPECT_EQ(sound.transmit(test::AcousticProbe::tone()), id) << "the number is used again";
}

TEST(Transmissions, AreCanceledExceptThePresentOne) {
  test::SoundObjects sound;
  const TransmissionId present = sound.transmit(test::AcousticProbe::tone());
  const TransmissionId pending = sound.transmit(test::AcousticProbe::tone());
  sound.transmissions.cancel_pending(sound.b.transducer, {});
  EXPECT_EQ(sound.transmissions[pending].from, &sound.a.transducer) << "of another";
  sound.transmissions.cancel_pending(sound.a.transducer, present);
  EXPECT_EQ(sound.transmissions[present].from, &sound.a.transducer);
  EXPECT_EQ(sound.transmissions[pending].from, nullptr);
}

TEST(Transmissions, AreTruncatedWithinTheirDuration) {
  test::SoundObjects sound;
  const TransmissionId id = sound.transmit(test::AcousticProbe::tone());  // 10 ms
  EXPECT_FALSE(sound.transmissions[id].truncated());
  sound.transmissions.truncate(id, sim::SignalLoss::sender_off, 4ms);
  EXPECT_TRUE(sound.transmissions[id].truncated());
  EXPECT_EQ(sound.transmissions[id].truncated_after, sim::Time{4ms});
  sound.transmissions.truncate(id, sim::SignalLoss::sender_off, 20ms);
  EXPECT_EQ(sound.transmissions[id].truncated_after, sim::Time{10ms});
}

TEST(Transmissions, AreRestoredWithTheirSenders) {
  test::SoundObjects sound;
  const TransmissionId id = sound.transmit(test::AcousticProbe::tone());
  const TransmissionId canceled = sound.transmit(test::AcousticProbe::tone());
  sound.transmissions.cancel_pending(sound.a.transducer, id);
  sim::StateArchive saver = sim::StateArchive::saver();
  sound.transmissions.visit_items(saver, 2, sound.transducers);
  const std::vector<std::byte> bytes = saver.take_bytes();
  sim::StateArchive restorer = sim::StateArchive::restorer(bytes);
  sim::Transmissions restored;
  restored.visit_items(restorer, 2, sound.transducers);
  EXPECT_EQ(restored[id].from, &sound.a.transducer);
  EXPECT_EQ(restored[canceled].from, nullptr);
  EXPECT_EQ(restored[id].signal.duration, sim::Time{10ms});
}

}  // namespace
