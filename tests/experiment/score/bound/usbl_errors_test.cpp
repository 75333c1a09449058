// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/bound/usbl_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/devices/world_fixture.hpp"

namespace {

constexpr double pi = std::numbers::pi;

TEST(UsblErrors, OfALevelArrayAreThoseOfBothCosinesTimesTheRange) {
  experiment::UsblErrors errors;
  errors.hearing.emplace();
  errors.hearing->array.baseline_m = 0.2;
  errors.hearing->array.phase_std_rad = 0.1;
  errors.hearing->tone = {sim::PowerRatio(1e30), 10, 0.05};
  errors.hearing->spreading.factor = 2;
  const double cosine_std = 0.05 / (2 * pi * 0.2) * 0.1;
  for (const sim::Vector3d& d_m : {sim::Vector3d(0, 0, -100), sim::Vector3d(60, 0, -80), sim::Vector3d(0, 99, -1)}) {
    EXPECT_NEAR(errors.at(d_m).along_m2, std::pow(d_m.norm() * cosine_std, 2), 1e-9);
    EXPECT_NEAR(errors.at(d_m).across_m2, std::pow(d_m.norm() * cosine_std, 2), 1e-9);
  }
}

TEST(UsblErrors, GrowAsTheAnswerGetsWeaker) {
  const sim::LoadedWorld loaded = sim::load_world_text(
      "shoal: 1\nphysics: {step_s: 0.01}\nmedium: {water: {sound_speed_mps: 1500}}\n"
      "acoustics: {spreading: {factor: 2}, absorption: {model: constant, dBpkm: 0}}\nvehicles:\n"
      "  - {name: boat, model: {shoal: 1, vehicle: v, bodies: [{name: hull, parts: [{shape: sphere, mass_kg: 1}]}], "
      "devices: [{name: usbl, type: usbl, array: {baseline_m: 0.1}}]}}\n"
      "  - {name: auv, model: {shoal: 1, vehicle: v, bodies: [{name: hull, parts: [{shape: sphere, mass_kg: 1}]}], "
      "devices: [{name: t, type: transponder, answer_frequency_Hz: 30000, source_level_dB: 150, ping_s: 0.02}]}}\n",
      "worlds/test.yaml", test::LoadedTestWorld::with_messages({}));
  std::vector<const sim::VehicleConfig*> vehicles;
  for (const sim::VehicleInstance& instance : loaded.config.vehicles) vehicles.push_back(instance.config.get());
  const sim::Medium medium(loaded.config.medium, 9.81, 1);
  const auto hearing = experiment::usbl_hearing(*vehicles[0], vehicles, loaded.config.acoustics, medium);
  ASSERT_TRUE(hearing);
  // 150 dB less 60 dB at 1 km over the noise in 1 kHz about 30 kHz, 20 times longer than 1 / 1 kHz.
  const double noise_dB = loaded.config.acoustics.noise.with_wind(medium.mean_wind_mps()).band_level(30000, 1000).dB();
  const double snr = std::pow(10, (150 - 60 - noise_dB) / 10);
  ASSERT_GT(snr, 100);
  const double expected = 0.05 / (2 * pi * 0.1) * std::sqrt((1 + 2 * snr) / (2 * snr * snr * 20));
  EXPECT_NEAR(hearing->cosine_std(1000), expected, 1e-9 * expected);
  EXPECT_NEAR(hearing->cosine_std(2000) / hearing->cosine_std(1000), 2, 0.02);
  // The AUV receives nothing by USBL.
  EXPECT_FALSE(experiment::usbl_hearing(*vehicles[1], vehicles, loaded.config.acoustics, medium));
  EXPECT_FALSE(experiment::usbl_hearing(*vehicles[0], {vehicles[0]}, loaded.config.acoustics, medium));
}

}  // namespace
