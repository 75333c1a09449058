// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/propagation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "sim/acoustics/rays/eigenrays.hpp"

namespace {

using sim::Eigenrays;
using sim::SoundProfile;
using sim::SoundRay;

constexpr double bottomless_m = 1e9;

sim::MultipathMedium lossless(double frequency_Hz) {
  sim::MultipathMedium water;
  water.frequency_Hz = frequency_Hz;
  return water;
}

std::vector<sim::PathGain> gains(const Eigenrays& rays, const sim::RayQuery& query, double frequency_Hz) {
  std::vector<SoundRay> found;
  rays.find(query, found);
  return sim::ray_gains(found, nullptr, lossless(frequency_Hz));
}

/// Loss of the sum of all powers, dB.
double loss_dB(const std::vector<sim::PathGain>& gains) {
  double power = 0;
  for (const sim::PathGain& gain : gains) power += sim::to_power(gain.gain).linear();
  return -10 * std::log10(power);
}

SoundProfile munk(double tolerance_mps = 5e-5) {
  const auto speed = [](double z_m) {
    const double eta = 2 * (z_m - 1300) / 1300;
    return 1500 * (1 + 0.00737 * (eta - 1 + std::exp(-eta)));
  };
  return SoundProfile::fitted(speed, {}, 5001, tolerance_mps);
}

TEST(RayGains, TheFirstConvergenceZoneOfTheMunkProfileIsAsLoudAsItsRayTubes) {
  // 50 m to 50 m, without bounces: an independent fan of 28 000 rays in the analytic profile.  1 dB: tubes of a fan are
  // finite differences.
  const Eigenrays rays(munk());
  for (const auto& [range_m, fan_dB] : {std::pair{65e3, 77.6}, {66e3, 83.2}, {67e3, 85.0}})
    EXPECT_NEAR(loss_dB(gains(rays, {50, 50, range_m, 5000, 0}, 1000)), fan_dB, 1) << range_m;
}

TEST(RayGains, AreSphericalSpreadingInWaterOfOneSpeed) {
  const Eigenrays rays(SoundProfile({{0, 1500}, {100, 1500}}));
  for (const double range_m : {2.0, 300.0, 20e3})
    EXPECT_NEAR(loss_dB(gains(rays, {50, 50, range_m, bottomless_m, 0}, 25000)), 20 * std::log10(range_m), 1e-9);
  EXPECT_EQ(loss_dB(gains(rays, {50, 50, 0.1, bottomless_m, 0}, 25000)), 0) << "nothing is louder than at 1 m";
}

TEST(RayGains, AreThoseOfAWaveAtACaustic) {
  // n^2 = 1 + 2 g z / c0: rays are parabolas, which return to their depth after r = r0 sin(2 a), r0 = c0 n_s^2 / g.  At
  // 45 degrees it is longest: beyond r0 none arrives, and before it there are two, which merge there.
  constexpr double pi = std::numbers::pi;
  const double c0 = 1500, g = 0.6, depth_m = 2500, frequency_Hz = 500, omega = 2 * pi * frequency_Hz;
  const auto speed = [&](double z_m) { return c0 / std::sqrt(1 + 2 * g * z_m / c0); };
  const double c = speed(depth_m), r0_m = c0 * c0 * c0 / (c * c) / g;
  const Eigenrays rays(SoundProfile::fitted(speed, {}, 3000, 3e-4));
  // The wave: the integral over the horizontal slowness xi = cos(a) / c in WKB approximation, whose stationary points
  // are the rays; its phase changes by omega (R - r) for each xi.  Angles from 20 to 70 degrees, faded in and out.
  const auto wave = [&](double range_m) {
    constexpr int steps = 100000;
    const double from_rad = 20 * pi / 180, to_rad = 70 * pi / 180, step_rad = (to_rad - from_rad) / steps;
    std::complex<double> sum = 0;
    double phase_rad = 0;
    for (int i = 0; i < steps; ++i) {
      const double share = (i + 0.5) / steps, a = from_rad + (i + 0.5) * step_rad;
      const double xi = std::cos(a) / c, s = std::sin(a), by_a = s / c * step_rad;
      const double change_rad = omega * (range_m - r0_m * std::sin(2 * a)) * by_a;
      const double fade = std::pow(std::sin(pi * std::min({share / 0.3, (1 - share) / 0.3, 1.0}) / 2), 2);
      sum += fade * std::sqrt(xi * c * c / (range_m * s * s)) * std::polar(by_a, phase_rad + change_rad / 2);
      phase_rad += change_rad;
    }
    return std::sqrt(omega / (2 * pi)) * std::abs(sum);
  };
  double loudest = 0, worst = 0;
  for (const double short_m : {0.01, 1.0, 3.0, 6.0, 10.0, 15.0, 20.0, 30.0, 40.0, 60.0, 80.0}) {
    std::complex<double> pressure = 0;
    const auto found = gains(rays, {depth_m, depth_m, r0_m - short_m, bottomless_m, 0}, frequency_Hz);
    ASSERT_EQ(found.size(), 2u) << short_m;
    for (const sim::PathGain& gain : found)
      pressure += std::polar(std::sqrt(sim::to_power(gain.gain).linear()), gain.phase_rad);
    const double expected = wave(r0_m - short_m);
    loudest = std::max(loudest, expected);
    worst = std::max(worst, std::abs(std::abs(pressure) - expected));
  }
  // 14 dB over spherical spreading.
  EXPECT_GT(loudest * r0_m, 5);
  EXPECT_LT(worst, 0.01 * loudest) << "by the layers; the formula is right to 0.05 %";
}

TEST(RayGains, DoNotDependOnTheLayersOfTheProfile) {
  // At the border of two layers the reach of a ray has a kink, at which tubes are thin by chance.
  const Eigenrays coarse(munk()), fine(munk(1e-5));
  std::vector<double> differences_dB;
  for (double range_m = 2000; range_m < 120e3; range_m += 977) {
    const auto by_coarse = gains(coarse, {1000, 800, range_m, 5000, 0}, 5000);
    const auto by_fine = gains(fine, {1000, 800, range_m, 5000, 0}, 5000);
    if (by_coarse.empty() || by_fine.empty()) continue;
    differences_dB.push_back(std::abs(loss_dB(by_coarse) - loss_dB(by_fine)));
  }
  ASSERT_GT(differences_dB.size(), 70u);
  std::sort(differences_dB.begin(), differences_dB.end());
  EXPECT_LT(differences_dB[differences_dB.size() / 2], 0.2);
  EXPECT_LT(differences_dB[differences_dB.size() * 95 / 100], 1);
  EXPECT_LT(differences_dB.back(), 3);
}

}  // namespace
