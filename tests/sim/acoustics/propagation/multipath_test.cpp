// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/multipath.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/sim/acoustics/config_text.hpp"

namespace {

using sim::BottomConfig;
using sim::Decibels;
using sim::ImagePath;
using sim::MultipathConfig;
using sim::MultipathMedium;
using sim::MultipathSum;
using sim::PathGain;

using std::numbers::pi;

std::vector<ImagePath> paths(double zs, double zr, double r, double depth, int bounces) {
  std::vector<ImagePath> all;
  sim::image_paths(zs, zr, r, depth, bounces, all);
  return all;
}

const ImagePath& path_with(const std::vector<ImagePath>& all, int surface, int bottom, bool upwards) {
  return *std::find_if(all.begin(), all.end(), [&](const ImagePath& each) {
    return each.surface_bounces == surface && each.bottom_bounces == bottom && each.leaves_upwards == upwards;
  });
}

TEST(Multipath, HasTheLengthsThatOneDrawsByHand) {
  // 100 m of water, source at 30 m, receiver at 60 m, 400 m apart: what each path climbs and sinks in all.
  const auto all = paths(30, 60, 400, 100, 3);
  const auto length = [&](int surface, int bottom, bool up) { return path_with(all, surface, bottom, up).length_m; };
  EXPECT_DOUBLE_EQ(length(0, 0, false), std::hypot(400, 30));
  EXPECT_DOUBLE_EQ(length(1, 0, true), std::hypot(400, 30 + 60));
  EXPECT_DOUBLE_EQ(length(0, 1, false), std::hypot(400, 70 + 40));
  EXPECT_DOUBLE_EQ(length(1, 1, true), std::hypot(400, 30 + 100 + 40));
  EXPECT_DOUBLE_EQ(length(1, 1, false), std::hypot(400, 70 + 100 + 60));
  EXPECT_DOUBLE_EQ(length(2, 1, true), std::hypot(400, 30 + 100 + 100 + 60));
  EXPECT_DOUBLE_EQ(length(1, 2, false), std::hypot(400, 70 + 100 + 100 + 40));
  EXPECT_DOUBLE_EQ(path_with(all, 1, 0, true).grazing_rad, std::atan2(90, 400));
  EXPECT_EQ(all.size(), 7u);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end(),
                             [](const ImagePath& a, const ImagePath& b) { return a.length_m < b.length_m; }));
  EXPECT_EQ(all.front().surface_bounces + all.front().bottom_bounces, 0);
}

TEST(Multipath, HasTwoMorePathsForEveryBounce) {
  for (int bounces = 0; bounces < 9; ++bounces)
    EXPECT_EQ(paths(1, 7, 50, 20, bounces).size(), static_cast<std::size_t>(1 + 2 * bounces));
  EXPECT_EQ(paths(1, 7, 50, std::numeric_limits<double>::infinity(), 9).size(), 2u) << "no bottom, one surface image";
  EXPECT_EQ(paths(1, 7, 50, std::numeric_limits<double>::infinity(), 0).size(), 1u);
}

RC_GTEST_PROP(Multipath, TakesTheMirrorImagesOfTheSource, ()) {
  const double depth = *rc::gen::inRange(10, 2000), zs = depth * *rc::gen::inRange(0, 101) / 100,
               zr = depth * *rc::gen::inRange(0, 101) / 100, r = *rc::gen::inRange(1, 5000);
  const int bounces = *rc::gen::inRange(0, 7);
  // Mirrors one after the other, at the surface (z -> -z) and at the bottom (z -> 2 D - z).
  std::vector<double> expected{std::hypot(r, zr - zs)};
  for (const bool surface_last : {true, false}) {
    double image = zs;
    for (int n = 1; n <= bounces; ++n) {
      image = zs;
      bool surface = (n % 2 == 1) == surface_last;
      for (int i = 0; i < n; ++i, surface = !surface) image = surface ? -image : 2 * depth - image;
      expected.push_back(std::hypot(r, image - zr));
    }
  }
  std::sort(expected.begin(), expected.end());
  const auto all = paths(zs, zr, r, depth, bounces);
  RC_ASSERT(all.size() == expected.size());
  for (std::size_t i = 0; i < all.size(); ++i) RC_ASSERT(std::abs(all[i].length_m - expected[i]) < 1e-9);
  const auto back = paths(zr, zs, r, depth, bounces);
  for (std::size_t i = 0; i < all.size(); ++i) RC_ASSERT(std::abs(all[i].length_m - back[i].length_m) < 1e-9);
}

/// A tone over a flat sea without a bottom.
MultipathSum lloyd_mirror(double zs, double zr, double r, double wavelength_m) {
  MultipathConfig config;
  config.surface_roughness_m = 0;
  MultipathMedium medium;
  medium.sound_speed_mps = 1500;
  medium.frequency_Hz = 1500 / wavelength_m;
  medium.spreading.factor = 2;
  std::vector<PathGain> gains;
  sim::path_gains(paths(zs, zr, r, std::numeric_limits<double>::infinity(), 1), config, medium, gains);
  return sim::combine(gains, 1);
}

TEST(Multipath, ASmoothSurfaceIsLloydsMirror) {
  // The surface turns the phase: silence where the paths differ by whole wavelengths, 6 dB more than one path has where
  // they differ by half a wavelength more.
  const double zs = 15, zr = 25, r = 900, direct_m = std::hypot(r, zr - zs), image_m = std::hypot(r, zr + zs);
  for (const int n : {1, 2, 5}) {
    const MultipathSum null = lloyd_mirror(zs, zr, r, (image_m - direct_m) / n);
    // What is left is the difference of the two spherical losses.
    EXPECT_NEAR(null.signal.linear(), std::pow(1 / direct_m - 1 / image_m, 2), 1e-15) << n;
    const MultipathSum crest = lloyd_mirror(zs, zr, r, (image_m - direct_m) / (n + 0.5));
    EXPECT_NEAR(sim::to_decibels(crest.signal).dB(), 20 * std::log10(1 / direct_m + 1 / image_m), 1e-6) << n;
  }
  // Far out, where the paths differ by 2 zs zr / r, small against the wavelength: the pressure falls with r^2.
  const auto far_dB = [&](double range_m) { return sim::to_decibels(lloyd_mirror(2, 2, range_m, 1).signal).dB(); };
  EXPECT_NEAR(far_dB(1000) - far_dB(2000), 40 * std::log10(2.0), 0.01);
}

TEST(Multipath, RoughSurfacesMirrorLess) {
  EXPECT_EQ(sim::surface_reflection(100, 0, 1), -1);
  EXPECT_DOUBLE_EQ(sim::surface_reflection(10, 0.2, pi / 6), -std::exp(-2.0));
  // Pierson and Moskowitz: 10 m/s of wind make waves of 2.14 m.
  EXPECT_NEAR(4 * sim::wind_sea_roughness_m(10), 2.14, 0.005);
  const auto surface_dB = [](const MultipathConfig& config) {
    std::vector<PathGain> gains;
    sim::path_gains({{1000, 2, 0, pi / 6, true}}, config, {1500, 1500, 0, 0, {2, {}}}, gains);
    return gains[0].gain.dB() + 60;
  };
  MultipathConfig config;
  config.surface_loss_dB = 1.5;
  EXPECT_NEAR(surface_dB(config), -3, 1e-12);
  config.surface_loss_dB.reset();
  EXPECT_NEAR(surface_dB(config), 0, 1e-12) << "no wind";
  config.surface_roughness_m = 0.1;
  // k = 2 pi: two bounces of exp(-2 (0.1 pi)^2) each.
  EXPECT_NEAR(surface_dB(config), 20 * std::log10(std::exp(-4 * std::pow(0.1 * pi, 2))), 1e-9);
}

TEST(Multipath, TheBottomMirrorsAsRayleighSays) {
  const BottomConfig sand{{}, 2.0, 1.2, 0};
  // Straight down: (z2 - z1) / (z2 + z1) of the impedances.
  EXPECT_NEAR(std::abs(sim::bottom_reflection(sand, pi / 2) - (2.4 - 1) / (2.4 + 1)), 0, 1e-12);
  // Flatter than the critical angle, cos = 1 / 1.2, nothing gets in.
  const double critical_rad = std::acos(1 / 1.2);
  for (const double share : {0.1, 0.5, 0.99})
    EXPECT_NEAR(std::abs(sim::bottom_reflection(sand, share * critical_rad)), 1, 1e-9) << share;
  EXPECT_LT(std::abs(sim::bottom_reflection(sand, 1.1 * critical_rad)), 0.8);
  EXPECT_NEAR(std::abs(sim::bottom_reflection(sand, 0) - -1.0), 0, 1e-12);
  // Mud that is slower than water lets all through at one angle: cot^2 = (n^2 - 1) / (m^2 - n^2) for n > 1, m > n.
  const double m = 1.5, n = 1 / 0.95;
  const BottomConfig mud{{}, m, 0.95, 0};
  const double cosine = std::sqrt((m * m - n * n) / (m * m - 1));
  EXPECT_NEAR(std::abs(sim::bottom_reflection(mud, std::acos(cosine))), 0, 1e-9);
  EXPECT_NEAR(std::abs(sim::bottom_reflection({10, 1, 1, 0}, 0.3)), std::sqrt(0.1), 1e-12);
}

RC_GTEST_PROP(Multipath, NoBottomGivesBackMoreThanItGets, ()) {
  const auto between = [](double low, double high) { return low + (high - low) * *rc::gen::inRange(0, 1001) / 1000; };
  const BottomConfig any{{}, between(0.1, 10), between(0.5, 5), between(0, 20)};
  RC_ASSERT(std::abs(sim::bottom_reflection(any, between(0, pi / 2))) <= 1 + 1e-12);
}

TEST(Multipath, AddsPressuresInsideTheWindowAndPowersAfterIt) {
  const auto two = [](double late_s, double phase_rad) {
    return std::vector<PathGain>{{0.5, Decibels(-60), 1}, {0.5 + late_s, Decibels(-60), 1 + phase_rad}};
  };
  const double power = 1e-6;
  EXPECT_NEAR(sim::combine(two(0.004, 0), 0.005).signal.linear(), 4 * power, 1e-18);
  EXPECT_NEAR(sim::combine(two(0.004, pi), 0.005).signal.linear(), 0, 1e-18);
  EXPECT_NEAR(sim::combine(two(0.004, pi / 2), 0.005).signal.linear(), 2 * power, 1e-18);
  const MultipathSum late = sim::combine(two(0.006, pi), 0.005);
  EXPECT_NEAR(late.signal.linear(), power, 1e-18);
  EXPECT_NEAR(late.interference.linear(), power, 1e-18);
  EXPECT_EQ(late.first_s, 0.5);
  EXPECT_NEAR(late.spread_s, 0.003, 1e-12) << "two equal paths: half of the time between them";
  EXPECT_EQ(sim::combine({}, 1).signal.linear(), 0);
}

TEST(Multipath, RandomPhasesAddPowersOnAverage) {
  const std::vector<PathGain> given{{0, Decibels(0), 0}, {0, Decibels(-3), 0}, {0, Decibels(-10), 0}};
  const double expected = 1 + std::pow(10, -0.3) + 0.1;
  sim::Random random(5, "phases");
  double sum = 0;
  const int packets = 20000;
  for (int i = 0; i < packets; ++i) {
    random.begin_step(i);
    std::vector<PathGain> gains = given;
    sim::randomize_phases(gains, random);
    sum += sim::combine(gains, 1).signal.linear() / packets;
  }
  // Standard deviation of one: sqrt of 2 times the sum of products of powers, about 1.1; 4 of the mean's.
  EXPECT_NEAR(sum, expected, 4 * 1.1 / std::sqrt(packets));
}

TEST(Multipath, ABottomWithoutLossAndASmoothSurfaceGiveACylindricalFieldOnAverage) {
  // In a lossless guide the mean power of all images is that of rays that stay between surface and bottom: its sum over
  // them, 1 / (r^2 + (2 D n)^2) in pairs, tends to pi / (D r): 10 log r instead of 20 log r.
  const double depth = 20, r = 2000;
  double sum = 0;
  for (const ImagePath& path : paths(7, 11, r, depth, 20000)) sum += 1 / (path.length_m * path.length_m);
  EXPECT_NEAR(sum, pi / (depth * r), 0.01 * pi / (depth * r));
}

TEST(Multipath, ReportsKeysThatDoNotGoTogether) {
  using test_support::config_error;
  EXPECT_THAT(config_error<MultipathConfig>("{surface_loss_dB: 1, surface_roughness_m: 0.1}"),
              testing::HasSubstr("exclude each other"));
  EXPECT_THAT(config_error<MultipathConfig>("bottom: {loss_dB: 1, speed_ratio: 1.1}"),
              testing::HasSubstr("'speed_ratio' and 'loss_dB' exclude each other"));
  EXPECT_EQ(test_support::read_config<MultipathConfig>("{phases: geometric, bottom: {loss_dB: 6}}").bottom.loss_dB, 6);
}

using sim::Echoes;
using sim::MultipathConfig;
using sim::MultipathMedium;

constexpr double no_bottom = std::numeric_limits<double>::infinity();

/// A surface that mirrors all, 1500 m/s, spherical spreading, no absorption.
MultipathConfig mirror() {
  MultipathConfig config;
  config.max_bounces = 1;
  config.surface_loss_dB = 0;
  return config;
}
MultipathMedium clear(double frequency_Hz = 25000) {
  return {frequency_Hz, 1500, 0, 0, {2, {}}};
}

TEST(Echoes, AddPowersWithoutPhases) {
  // 20 m deep, 40 m apart: the surface path is sqrt(2) times as long, half the power, 11.05 ms later.
  MultipathConfig config = mirror();
  config.window_s = 0.0111;
  const Echoes near = sim::echoes(config, clear(), {20, 20, 40, no_bottom}, nullptr);
  EXPECT_NEAR(near.signal.linear(), 1.5, 1e-9);
  EXPECT_EQ(near.late.linear(), 0);
  config.window_s = 0.0110;
  const Echoes late = sim::echoes(config, clear(), {20, 20, 40, no_bottom}, nullptr);
  EXPECT_NEAR(late.signal.linear(), 1, 1e-12);
  EXPECT_NEAR(late.late.linear(), 0.5, 1e-9);
}

TEST(Echoes, KeepThePhasesOfTheLengthsWhenTheseAreAsked) {
  MultipathConfig config = mirror();
  config.phases = MultipathConfig::Phases::geometric;
  config.window_s = 1;
  // A wavelength of the difference in length: silence except for the difference in spreading.
  const double longer_m = 40 * (std::sqrt(2.0) - 1);
  EXPECT_NEAR(sim::echoes(config, clear(1500 / longer_m), {20, 20, 40, no_bottom}, nullptr).signal.linear(),
              std::pow(1 - 1 / std::sqrt(2.0), 2), 1e-9);
}

TEST(Echoes, DrawnPhasesStayBetweenSilenceAndTheSum) {
  const MultipathConfig config = mirror();
  sim::Random random(1, "a>b");
  double low = 9, high = 0;
  for (int packet = 0; packet < 200; ++packet) {
    random.begin_step(packet);
    const double signal = sim::echoes(config, clear(), {5, 5, 500, no_bottom}, &random).signal.linear();
    low = std::min(low, signal);
    high = std::max(high, signal);
  }
  EXPECT_LT(low, 0.05);
  EXPECT_GT(high, 3.9);
  EXPECT_LE(high, 4);
}

TEST(Echoes, NoneWithoutBounces) {
  MultipathConfig config = mirror();
  config.max_bounces = 0;
  const Echoes none = sim::echoes(config, clear(), {20, 30, 400, 50}, nullptr);
  EXPECT_EQ(none.signal.linear(), 1);
  EXPECT_EQ(none.late.linear(), 0);
  EXPECT_EQ(none.spread_s, 0);
}

TEST(Echoes, AreThereWhereNothingIsLeftOfTheSound) {
  // 1e6 m at 6 dB/km: powers of 1e-600 are zero as numbers, their ratios are not.
  MultipathMedium far = clear();
  far.absorption_dBpkm = 6;
  EXPECT_NEAR(sim::echoes(mirror(), far, {20, 20, 1e6, no_bottom}, nullptr).signal.linear(), 2, 1e-3);
}

TEST(Echoes, OfEndsBeyondTheWaterAreThoseAtItsBounds) {
  MultipathConfig config = mirror();
  config.max_bounces = 3;
  const auto at = [&](double source_m, double receiver_m) {
    return sim::echoes(config, clear(), {source_m, receiver_m, 400, 50}, nullptr).signal.linear();
  };
  EXPECT_EQ(at(-1, 60), at(0, 50));
}

}  // namespace
