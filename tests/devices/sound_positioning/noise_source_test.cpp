// SPDX-License-Identifier: BSD-3-Clause
#include "devices/sound_positioning/noise_source.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "shoal/actuator_command_t.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "tests/devices/sound_positioning/acoustic_probe.hpp"

namespace {

std::string noise_world(const std::string& keys, const std::string& position_m = "[1000, 100, -50]") {
  return test::sound_world(test::float_at("sender", "[0, 0, -50]") + test::float_at("receiver", "[1000, 0, -50]") +
                           test::float_at("noisy", position_m, "{name: n, type: noise_source" + keys + "}"));
}

/// What the receiver, 1000 m from the sender, makes of 180 dB from there: 120 dB, by spherical spreading.
test::AcousticProbe::Received overheard(test::TestWorld& test, double duration_s = 0.01) {
  test::AcousticProbe sender(test, "sender"), receiver(test, "receiver");
  receiver.all.clear();
  sender.send(test::AcousticProbe::tone(180, duration_s));
  test.run_for(1000.0 / 1500 + duration_s + 0.05);
  for (const auto& received : receiver.all)
    if (received.source == "sender/probe") return received;
  throw std::runtime_error("nothing was received");
}

const devices::NoiseSource& source(const test::TestWorld& test) {
  return dynamic_cast<const devices::NoiseSource&>(*test.world.find_vehicle("noisy")->find_device("n")->actuator());
}

// The noise of the sea is 50 dB below: 4e-5 dB.
constexpr double of_the_sea_dB = 1e-3;

TEST(NoiseSource, LeavesTheDifferenceOfLevelsAsTheRatioOfSignalToNoise) {
  // 150 dB from 100 m: 110 dB in the band of the signal, 10 dB less than the signal has.
  test::TestWorld test(noise_world(", level_dB: 150"));
  const auto received = overheard(test);
  EXPECT_NEAR(received.level_dB, 120, 1e-9);
  EXPECT_NEAR(received.snr_dB, 10, of_the_sea_dB);
  EXPECT_NEAR(received.sinr_dB, 10, of_the_sea_dB);
  EXPECT_EQ(received.loss, sim::SignalLoss::none);
}

TEST(NoiseSource, CountsWithThePartOfItsPowerThatIsInTheBand) {
  // The signal fills 23 to 27 kHz: half of the noise from 21 to 29 kHz, a quarter of that from 26 to 30 kHz.
  test::TestWorld wide(noise_world(", level_dB: 150, bandwidth_Hz: 8000"));
  EXPECT_NEAR(overheard(wide).snr_dB, 10 + 10 * std::log10(2), of_the_sea_dB);
  test::TestWorld beside(noise_world(", level_dB: 150, frequency_Hz: 28000"));
  EXPECT_NEAR(overheard(beside).snr_dB, 10 + 10 * std::log10(4), of_the_sea_dB);
  test::TestWorld apart(noise_world(", level_dB: 150, frequency_Hz: 35000"));
  EXPECT_GT(overheard(apart).snr_dB, 45);
}

TEST(NoiseSource, DrownsASignalThatIsNotAboveItByTheDetectionThreshold) {
  // 6 dB are needed; 154.5 and 153.5 dB leave 5.5 and 6.5.
  test::TestWorld loud(noise_world(", level_dB: 154.5"));
  EXPECT_EQ(overheard(loud).loss, sim::SignalLoss::noise);
  test::TestWorld soft(noise_world(", level_dB: 153.5"));
  EXPECT_EQ(overheard(soft).loss, sim::SignalLoss::none);
}

TEST(NoiseSource, IsTurnedOffAndOnByCommandsAndEventsAndAtAnEmergencyStop) {
  test::TestWorld test(noise_world(", level_dB: 150"));
  const auto command = [&](double value) {
    shoal::actuator_command_t message{};
    message.value = value;
    test.send("noisy.n.cmd", message);
    test.run_for(0.02);
  };
  EXPECT_NEAR(overheard(test).snr_dB, 10, of_the_sea_dB);
  command(0);
  EXPECT_GT(overheard(test).snr_dB, 45);
  command(1);
  EXPECT_NEAR(overheard(test).snr_dB, 10, of_the_sea_dB);
  EXPECT_EQ(test.change("noisy/n", "{on: false}"), "");
  EXPECT_GT(overheard(test).snr_dB, 45);
  EXPECT_EQ(test.change("noisy/n", "{on: true, level_dB: 140}"), "");
  EXPECT_NEAR(overheard(test).snr_dB, 20, of_the_sea_dB);
  test.world.vehicles()[2]->systems().estopped = true;
  EXPECT_GT(overheard(test).snr_dB, 45);
}

TEST(NoiseSource, IsSilentWithoutPowerAndInAir) {
  test::TestWorld dead(noise_world(", level_dB: 150"));
  dead.world.vehicles()[2]->systems().powered = false;
  EXPECT_GT(overheard(dead).snr_dB, 45);
  test::TestWorld in_air(noise_world(", level_dB: 150", "[1000, 0, 10]"));
  EXPECT_GT(overheard(in_air).snr_dB, 45);
}

TEST(NoiseSource, SoundsForItsPartOfEachPeriod) {
  test::TestWorld test(noise_world(", period_s: 0.2, sound_s: 0.05"));
  int sounding = 0;
  for (int step = 0; step < 1000; ++step) {
    test.world.step();
    sounding += source(test).sounding() ? 1 : 0;
  }
  EXPECT_EQ(sounding, 250);
}

TEST(NoiseSource, PulsesTravelAndDisturbOnlyWhatTheyOverlap) {
  // One pulse each second, 0.1 s long, that arrives 150 m / (1500 m/s) after it is sent, with 160 - 43.5 dB.
  const std::string keys = ", kind: pulses, level_dB: 150, period_s: 1, sound_s: 0.1";
  const std::string place = "[1000, 150, -50]";
  const double sinr_dB = 120 - (150 - 20 * std::log10(150));
  // Sent at 0, the signal is there from 0.667 s on for 0.01 s: between the pulses, which are there from 0.1 to 0.2 s.
  test::TestWorld between(noise_world(keys, place));
  EXPECT_GT(overheard(between).sinr_dB, 45);
  // A longer one, up to 1.267 s, meets the pulse from 1.1 s on.
  test::TestWorld met(noise_world(keys, place));
  const auto received = overheard(met, 0.6);
  EXPECT_GT(received.snr_dB, 45);
  EXPECT_NEAR(received.sinr_dB, sinr_dB, of_the_sea_dB);
  // And when it is received itself, it is at the right time and means nothing.
  test::TestWorld alone(noise_world(keys, place));
  test::AcousticProbe receiver(alone, "receiver");
  alone.run_for(2.3);
  ASSERT_EQ(receiver.all.size(), 3u);
  EXPECT_EQ(receiver.all[1].signal.kind, sim::Signal::Kind::noise);
  EXPECT_EQ(receiver.all[1].started, sim::from_seconds(1.1));
  EXPECT_EQ(receiver.all[1].ended, sim::from_seconds(1.2));
}

TEST(NoiseSource, SaysWhatIsWrongWithItsParameters) {
  EXPECT_THAT(test::error_of_world(noise_world(", kind: pulses")),
              testing::HasSubstr("kind 'pulses' needs a 'period_s'"));
  EXPECT_THAT(test::error_of_world(noise_world(", period_s: 0.01, sound_s: 0.1")),
              testing::HasSubstr("'sound_s' must be at most 'period_s'"));
  EXPECT_THAT(test::error_of_world(test::rover_world("        - {name: n, type: noise_source}\n")),
              testing::HasSubstr("a device of type 'noise_source' needs water"));
}

}  // namespace
