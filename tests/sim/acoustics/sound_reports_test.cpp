// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/sound_reports.hpp"

#include <gtest/gtest.h>

#include "tests/sim/acoustics/sound_objects.hpp"

namespace {

using sim::SignalLoss;

struct Observed final : sim::SoundObserver {
  int sent = 0;
  std::vector<SignalLoss> arrived;
  void sound_sent(const sim::SoundSent&) override { ++sent; }
  void sound_arrived(const sim::SoundArrived& each) override { arrived.push_back(each.loss); }
};

TEST(SoundReports, AMessageIsReportedWithItsAddresseesBeyondTheRange) {
  test::SoundObjects sound;
  Observed observed;
  sound.b.transducer.set_address({"modems", "b"});
  sim::Signal message = test::AcousticProbe::tone();
  message.to = {"modems", ""};
  const sim::Transmission& transmission = sound.transmissions[sound.transmit(message)];
  sound.reports.transmitted(transmission, 99);
  sound.reports.set_observer(&observed);
  sound.reports.transmitted(transmission, 101);
  EXPECT_EQ(observed.sent, 1);
  EXPECT_TRUE(observed.arrived.empty()) << "it has a flight";
  sound.reports.transmitted(transmission, 99);
  EXPECT_EQ(observed.arrived, std::vector<SignalLoss>{SignalLoss::range});
}

TEST(SoundReports, OnlyListenersAndAddresseesBeyondTheMaximumRangeAreReported) {
  test::SoundObjects sound;
  Observed observed;
  sound.reports.set_observer(&observed);
  const sim::TransmissionId id = sound.transmit(test::AcousticProbe::tone());
  sim::Flight flight;
  const auto arrive = [&] { sound.reports.arrived(flight, sound.transmissions[id], sound.b.transducer); };
  arrive();
  flight.loss = SignalLoss::range;
  arrive();
  EXPECT_TRUE(observed.arrived.empty());
  flight.addressed = true;
  arrive();
  flight = {};
  flight.listened = true;
  arrive();
  EXPECT_EQ(observed.arrived, (std::vector<SignalLoss>{SignalLoss::range, SignalLoss::none}));
}

TEST(SoundReports, TheFirstMessagesLostInShadowsAreKept) {
  test::SoundObjects sound;
  const sim::TransmissionId id = sound.transmit(test::AcousticProbe::tone());
  sim::Flight flight;
  flight.listened = flight.addressed = true;
  flight.loss = SignalLoss::shadow;
  flight.p_started_W = sound.b.transducer.p_W(sim::Time{0});
  for (std::size_t i = 0; i <= sim::SoundReports::max_shadow_losses; ++i)
    sound.reports.arrived(flight, sound.transmissions[id], sound.b.transducer);
  ASSERT_EQ(sound.reports.shadow_losses().size(), sim::SoundReports::max_shadow_losses);
  EXPECT_EQ(sound.reports.shadow_losses()[0].receiver, "b/probe");
  EXPECT_NEAR(sound.reports.shadow_losses()[0].range_m, 100, 1e-9);
}

}  // namespace
