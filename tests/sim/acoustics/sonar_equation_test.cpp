// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/sonar_equation.hpp"

#include <gtest/gtest.h>

#include "tests/sim/acoustics/sound_objects.hpp"

namespace {

using namespace std::chrono_literals;
using sim::SignalLoss;

sim::SonarEquation::Level level_at_b(test::SoundObjects& sound) {
  const sim::TransmissionId id = sound.transmit(test::AcousticProbe::tone(180));
  const sim::Transducer& b = sound.b.transducer;
  return sound.sonar.level_at(b, b.p_W(0s), 66ms, sound.transmissions[id]);
}

TEST(SonarEquation, LevelIsTheSourceLevelLessTheLosses) {
  test::SoundObjects sound;
  const sim::SonarEquation::Level found = level_at_b(sound);
  EXPECT_NEAR(found.level.dB(), 180 - 40, 1e-9);  // 20 log 100
  EXPECT_EQ(found.ended, sim::Time{76ms}) << "both are at rest";
  EXPECT_EQ(found.closing_mps, 0);
  EXPECT_FALSE(found.blocked || found.shadow || found.bent);
  test::SoundObjects with_link(", links: [{from: a, to: b, extra_loss_dB: 7}]");
  EXPECT_NEAR(level_at_b(with_link).level.dB(), 180 - 40 - 7, 1e-9);
}

TEST(SonarEquation, ContinuousSoundsAddTheirPowerToTheNoise) {
  test::SoundObjects sound;
  const sim::Signal tone = test::AcousticProbe::tone();  // 25 kHz, 4 kHz wide
  sim::ContinuousSound engine(sim::Decibels{150}, 26000, 4000, sound.site("a/engine"));
  const auto noise = [&] {
    return sound.sonar.noise_at(sound.b.transducer, sound.b.transducer.p_W(0s), tone).linear();
  };
  const double sea = noise();
  sound.sonar.add(engine);
  // Three quarters of its band are in that of the signal: 150 dB less 20 log 100.
  EXPECT_NEAR((noise() - sea) / 1e11, 0.75, 1e-6);
  engine.set_on(false);
  EXPECT_EQ(noise(), sea);
  engine.set_on(true);
  sound.sonar.remove(engine);
  EXPECT_EQ(noise(), sea);
}

TEST(SonarEquation, ALossIsByNoiseOrInterferenceOrLink) {
  test::SoundObjects sound;
  const sim::Transmission& transmission = sound.transmissions[sound.transmit(test::AcousticProbe::tone())];
  const auto lost = [&](const test::SoundObjects& in, double success, double success_alone) {
    return in.sonar.lost(sound.b.transducer, transmission, {success, success_alone, {}}, SignalLoss::none);
  };
  EXPECT_EQ(lost(sound, 1, 1), SignalLoss::none);
  EXPECT_EQ(lost(sound, 0, 1), SignalLoss::interference);
  EXPECT_EQ(lost(sound, 0, 0), SignalLoss::noise);
  test::SoundObjects bad_link(", links: [{from: a, to: b, loss_probability: 1}]");
  EXPECT_EQ(lost(bad_link, 1, 1), SignalLoss::link);
}

}  // namespace
