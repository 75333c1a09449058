// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/rays/eigenrays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "sim/acoustics/propagation/multipath.hpp"
#include "sim/acoustics/rays/ray_tables.hpp"
#include "sim/acoustics/rays/ray_trace.hpp"
#include "sim/medium/water_column.hpp"
#include "tests/project_paths.hpp"

namespace {

using sim::Eigenrays;
using sim::RayQuery;
using sim::SoundProfile;
using sim::SoundRay;

constexpr double no_bottom = 1e9;
constexpr double degree = std::numbers::pi / 180;

std::vector<SoundRay> find(const Eigenrays& rays, const RayQuery& query) {
  std::vector<SoundRay> found;
  rays.find(query, found);
  return found;
}

double loss_dB(const SoundRay& ray) {
  return -10 * std::log10(ray.power_per_m2);
}

TEST(Eigenrays, RaysInOneGradientAreArcsOfCircles) {
  const double g = -0.2;
  const Eigenrays rays(SoundProfile({{0, 1500}, {1000, 1500 + 1000 * g}}));
  for (const double range_m : {1.0, 200.0, 600.0})
    for (const double deeper_m : {0.0, 30.0, 400.0}) {
      const auto found = find(rays, {300, 300 + deeper_m, range_m, no_bottom, 0});
      ASSERT_EQ(found.size(), 1u) << range_m << ' ' << deeper_m;
      const double c1 = 1500 + 300 * g, c2 = c1 + deeper_m * g;
      const double time_s =
          std::acosh(1 + g * g * (range_m * range_m + deeper_m * deeper_m) / (2 * c1 * c2)) / std::abs(g);
      EXPECT_NEAR(found[0].travel_time_s, time_s, 1e-11) << range_m << ' ' << deeper_m;
      // The center of the circle is where c would be 0, and halfway between in the sense of its equation.
      const double z1_m = c1 / g, z2_m = c2 / g;
      const double center_m = (range_m * range_m + z2_m * z2_m - z1_m * z1_m) / (2 * range_m);
      EXPECT_NEAR(found[0].launch_rad, std::atan2(center_m, -z1_m), 1e-9) << range_m << ' ' << deeper_m;
      EXPECT_NEAR(found[0].arrival_rad, std::atan2(center_m - range_m, -z2_m), 1e-9) << range_m << ' ' << deeper_m;
    }
}

TEST(Eigenrays, InWaterOfOneSpeedTheyAreTheImagesOfThePekerisGuide) {
  const double c = 1500, water_m = 80;
  const Eigenrays rays(SoundProfile({{0, c}, {water_m, c}, {100, c}}));
  for (const double receiver_m : {5.0, 20.0, 70.0})
    for (const double range_m : {0.0, 1e-5, 10.0, 300.0, 4000.0}) {
      std::vector<sim::ImagePath> images;
      sim::image_paths(20, receiver_m, range_m, water_m, 5, images);
      const auto found = find(rays, {20, receiver_m, range_m, water_m, 5});
      ASSERT_EQ(found.size(), images.size()) << receiver_m << ' ' << range_m;
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i].travel_time_s, images[i].length_m / c, 1e-9);
        EXPECT_NEAR(std::abs(found[i].launch_rad), images[i].grazing_rad, 1e-7);
        EXPECT_NEAR(loss_dB(found[i]), 20 * std::log10(std::max(images[i].length_m, 1e-6)), 1e-5);
      }
    }
}

TEST(Eigenrays, LossesInWaterWithSquaredSlownessLinearInDepthAreThoseOfParabolas) {
  // n^2 = 1 + 2 g z / c0: z = r tan a + g r^2 / (2 c0 n_s^2 cos^2 a), angles downwards (Pedersen and Gordon 1972).
  const double c0 = 1500, g = 0.6, source_m = 150;
  const auto speed = [&](double z) { return c0 / std::sqrt(1 + 2 * g * z / c0); };
  const Eigenrays rays(SoundProfile::fitted(speed, {}, 1000));
  const double n2 = c0 * c0 / (speed(source_m) * speed(source_m));
  int compared = 0;
  for (double a = -30; a < 30; a += 0.37)
    for (const double range_m : {150.0, 400.0, 900.0}) {
      const double t = std::tan(a * degree), sec2 = 1 + t * t, bend = g * range_m * range_m / (2 * c0 * n2);
      const double receiver_m = source_m + range_m * t + bend * sec2;
      double highest_m = source_m;  // of the parabola: it must stay in the water
      if (t < 0) highest_m = source_m - t * t * c0 * n2 / (2 * g * sec2);
      const double spread = std::abs(range_m + 2 * bend * t) * sec2 / range_m;
      if (receiver_m < 1 || receiver_m > 900 || highest_m < 1 || spread < 0.125) continue;
      const double arrival = std::atan(t + 2 * bend * sec2 / range_m);
      const double expected_dB = -10 * std::log10(speed(receiver_m) / speed(source_m) * std::cos(a * degree) /
                                                  (range_m * range_m * spread * std::cos(arrival)));
      const auto found = find(rays, {source_m, receiver_m, range_m, no_bottom, 0});
      const auto same = std::min_element(found.begin(), found.end(), [&](const SoundRay& x, const SoundRay& y) {
        return std::abs(x.launch_rad + a * degree) < std::abs(y.launch_rad + a * degree);
      });
      ASSERT_NE(same, found.end()) << a << ' ' << range_m;
      EXPECT_NEAR(same->launch_rad, -a * degree, 1e-3 * degree) << range_m;
      EXPECT_NEAR(loss_dB(*same), expected_dB, 0.5) << a << ' ' << range_m;
      ++compared;
    }
  EXPECT_GT(compared, 200);
}

/// Speeds of the five profiles of reference_rays.py.
const std::map<std::string, Eigenrays>& profiles() {
  static const std::map<std::string, Eigenrays> made = [] {
    const std::map<std::string, std::vector<std::array<double, 3>>> rows{
        {"isothermal", {{0, 10, 35}, {250, 10, 35}}},
        {"thermocline", {{0, 18, 35}, {20, 18, 35}, {40, 8, 35}, {200, 8, 35}}},
        {"duct", {{0, 14, 35}, {60, 14, 35}, {90, 9, 35}, {200, 7, 35}}},
        {"measured",
         {{0, 19.3, 34.1},
          {2, 19.25, 34.1},
          {4, 19.1, 34.15},
          {7, 18.2, 34.3},
          {9, 17.9, 34.3},
          {12, 16.0, 34.5},
          {14, 13.1, 34.7},
          {17, 12.4, 34.75},
          {21, 11.2, 34.8},
          {28, 10.4, 34.85},
          {40, 9.6, 34.9},
          {55, 9.1, 34.95},
          {80, 8.9, 35.0},
          {120, 8.6, 35.0}}}};
    std::map<std::string, Eigenrays> profiles;
    for (const auto& [name, layers] : rows) {
      sim::WaterConfig config;
      std::vector<double> depths_m;
      for (const auto& [depth_m, temperature_C, salinity_psu] : layers) {
        config.profile.push_back({depth_m, temperature_C, salinity_psu, {}, {}});
        depths_m.push_back(depth_m);
      }
      const sim::WaterColumn column(config, 9.81);
      profiles.emplace(name, SoundProfile::fitted([&](double z) { return column.sound_speed_mps(z); }, depths_m,
                                                  depths_m.back() + 1));
    }
    const auto munk = [](double z) {
      const double eta = 2 * (z - 1300) / 1300;
      return 1500 * (1 + 0.00737 * (eta - 1 + std::exp(-eta)));
    };
    profiles.emplace("munk", SoundProfile::fitted(munk, {}, 5001));
    return profiles;
  }();
  return made;
}

TEST(Eigenrays, AgreeWithTwoThousandRaysByNumericalIntegration) {
  // reference_rays.csv is the output of reference_rays.py.
  const std::map<std::string, double> water_m{
      {"isothermal", 250}, {"thermocline", 200}, {"duct", 200}, {"munk", 5000}, {"measured", 120}};
  std::ifstream file(test_support::source_path("tests/sim/acoustics/rays/reference_rays.csv"));
  std::string line;
  std::getline(file, line);
  int count = 0, near_caustic = 0, far_off = 0;
  std::vector<double> losses_dB;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream text(line);
    std::string profile;
    double source_m = 0, receiver_m = 0, range_m = 0, launch_deg = 0, arrival_deg = 0, time_s = 0, spread = 0;
    int surface = 0, bottom = 0;
    text >> profile >> source_m >> receiver_m >> range_m >> launch_deg >> arrival_deg >> time_s >> surface >> bottom >>
        spread;
    ASSERT_TRUE(text) << line;
    ++count;
    const auto found = find(profiles().at(profile), {source_m, receiver_m, range_m, water_m.at(profile), 3});
    const SoundRay* same = nullptr;
    for (const SoundRay& ray : found)
      if (ray.surface_bounces == surface && ray.bottom_bounces == bottom &&
          (same == nullptr ||
           std::abs(ray.launch_rad / degree - launch_deg) < std::abs(same->launch_rad / degree - launch_deg)))
        same = &ray;
    // Nine decibels and more of focusing: there both errors and losses grow without limit.
    if (spread < 0.125) {
      ++near_caustic;
      far_off += same == nullptr || std::abs(same->launch_rad / degree - launch_deg) > 0.1;
      continue;
    }
    ASSERT_NE(same, nullptr) << line;
    EXPECT_NEAR(same->travel_time_s, time_s, 1e-6) << line;
    EXPECT_NEAR(same->launch_rad / degree, launch_deg, 1e-3) << line;
    EXPECT_NEAR(same->arrival_rad / degree, arrival_deg, 1e-3) << line;
    const double expected_dB =
        -10 * std::log10(std::cos(launch_deg * degree) / (range_m * range_m * spread * std::cos(arrival_deg * degree)));
    losses_dB.push_back(std::abs(loss_dB(*same) - expected_dB));
  }
  EXPECT_EQ(count, 2000);
  EXPECT_LT(near_caustic, 120);
  EXPECT_LE(far_off, 5);
  // Without the ratio of the speeds, 0.15 dB at most.
  std::sort(losses_dB.begin(), losses_dB.end());
  EXPECT_LT(losses_dB[losses_dB.size() / 2], 0.1);
  EXPECT_LT(losses_dB[losses_dB.size() * 99 / 100], 1);
}

TEST(Eigenrays, FindTheKnownArrivalsOfTheMunkProfile) {
  // Case MunkB_eigenray of the Acoustics Toolbox: 1000 m to 800 m, 100 km; times and launch angles by BELLHOP with a
  // step of 20 m, whose arrivals are in single precision (8 us at 67 s).
  const Eigenrays rays(SoundProfile(
      {{0, 1548.52},    {200, 1530.29},  {250, 1526.69},  {400, 1517.78},  {600, 1509.49},  {800, 1504.30},
       {1000, 1501.38}, {1200, 1500.14}, {1400, 1500.12}, {1600, 1501.02}, {1800, 1502.57}, {2000, 1504.62},
       {2200, 1507.02}, {2400, 1509.69}, {2600, 1512.55}, {2800, 1515.56}, {3000, 1518.67}, {3200, 1521.85},
       {3400, 1525.10}, {3600, 1528.38}, {3800, 1531.70}, {4000, 1535.04}, {4200, 1538.39}, {4400, 1541.76},
       {4600, 1545.14}, {4800, 1548.52}, {5000, 1551.91}, {5001, 1551.93}}));
  struct Known {
    double time_s, down_deg;
    int surface, bottom;
  };
  const auto found = find(rays, {1000, 800, 100000, 5000, 7});
  for (const Known& known : {Known{66.60372, 9.577, 0, 0},
                             {66.64444, 5.617, 0, 0},
                             {66.74455, 15.026, 1, 2},
                             {66.96183, 15.405, 2, 2},
                             {67.03181, -15.488, 2, 2},
                             {67.26161, -15.980, 3, 2},
                             {68.30753, 18.481, 2, 3},
                             {68.60474, 19.156, 3, 3},
                             {68.69170, -19.305, 3, 3},
                             {69.00593, -19.999, 4, 3}}) {
    const bool there = std::any_of(found.begin(), found.end(), [&](const SoundRay& ray) {
      return std::abs(ray.travel_time_s - known.time_s) < 20e-6 &&
             std::abs(ray.launch_rad / degree + known.down_deg) < 2e-3 && ray.surface_bounces == known.surface &&
             ray.bottom_bounces == known.bottom;
    });
    EXPECT_TRUE(there) << known.time_s;
  }
}

TEST(Eigenrays, NoRayReachesTheShadowBehindTheOneThatGrazesTheSurface) {
  const double g = -0.3, c0 = 1510;
  const Eigenrays rays(SoundProfile({{0, c0}, {500, c0 + 500 * g}}));
  // The ray that is horizontal at the surface: x^2 = R^2 - (R - z)^2 with R = c0 / |g|.
  const double radius_m = c0 / std::abs(g);
  const auto reach_m = [&](double z_m) { return std::sqrt(2 * radius_m * z_m - z_m * z_m); };
  const double edge_m = reach_m(10) + reach_m(40);
  EXPECT_EQ(find(rays, {10, 40, edge_m - 0.01, no_bottom, 0}).size(), 1u);
  EXPECT_TRUE(find(rays, {10, 40, edge_m + 0.01, no_bottom, 0}).empty());
}

TEST(Eigenrays, ASurfaceDuctCarriesSoundThatTurnsBackUpwards) {
  // Slower at the surface: rays turn at the depth where they are horizontal, and bounce off the surface.
  const Eigenrays rays(SoundProfile({{0, 1500}, {100, 1501.6}, {200, 1480}}));
  const auto found = find(rays, {5, 5, 3000, no_bottom, 3});
  ASSERT_FALSE(found.empty());
  const double steepest_rad = std::acos(rays.profile().speed_mps(5) / 1501.6);
  for (const SoundRay& ray : found) {
    EXPECT_LT(std::abs(ray.launch_rad), steepest_rad);
    EXPECT_EQ(ray.bottom_bounces, 0);
    EXPECT_LE(std::abs(ray.turns - ray.surface_bounces), 1) << ray.launch_rad;
    EXPECT_GE(ray.turns, 1) << ray.launch_rad;
  }
}

TEST(Eigenrays, AreTheSameBackwards) {
  const Eigenrays& rays = profiles().at("measured");
  for (const double range_m : {50.0, 700.0, 2500.0}) {
    const auto there = find(rays, {8, 60, range_m, 120, 3}), back = find(rays, {60, 8, range_m, 120, 3});
    ASSERT_EQ(there.size(), back.size());
    for (std::size_t i = 0; i < there.size(); ++i) {
      EXPECT_EQ(there[i].travel_time_s, back[i].travel_time_s);
      EXPECT_EQ(there[i].launch_rad, -back[i].arrival_rad);
      EXPECT_EQ(there[i].arrival_rad, -back[i].launch_rad);
    }
  }
}

TEST(Eigenrays, TracesOfTheirLaunchAnglesEndAtTheReceiver) {
  const Eigenrays& rays = profiles().at("thermocline");
  int traced = 0;
  for (const SoundRay& ray : find(rays, {30, 25, 1200, 100, 3})) {
    const sim::RayTrace trace = sim::trace_ray(rays.profile(), 30, ray.launch_rad, 100, 1200, 1);
    ASSERT_EQ(trace.depth_m.size(), 2u);
    EXPECT_NEAR(trace.depth_m[0], 30, 1e-9);
    EXPECT_NEAR(trace.depth_m[1], 25, 1e-3);
    EXPECT_EQ(trace.surface_bounces, ray.surface_bounces);
    EXPECT_EQ(trace.bottom_bounces, ray.bottom_bounces);
    ++traced;
  }
  EXPECT_GE(traced, 4);
}

TEST(Eigenrays, AreAtTheReceiverAfterTheirTravelTime) {
  for (const char* name : {"isothermal", "thermocline", "duct"}) {
    const Eigenrays& rays = profiles().at(name);
    int placed = 0;
    for (const double range_m : {40.0, 350.0, 900.0})
      for (const SoundRay& ray : find(rays, {35, 22, range_m, no_bottom, 2})) {
        const sim::RayPlace place = sim::ray_place(rays.profile(), 35, ray.launch_rad, ray.travel_time_s);
        EXPECT_NEAR(place.range_m, range_m, 1e-4) << name;
        EXPECT_NEAR(place.depth_m, 22, 1e-4) << name;
        ++placed;
      }
    EXPECT_GE(placed, 4) << name;
  }
  const sim::RayPlace below = sim::ray_place(SoundProfile({{0, 1500}, {100, 1500}}), 10, -std::numbers::pi / 2, 0.02);
  EXPECT_NEAR(below.range_m, 0, 1e-6);
  EXPECT_NEAR(below.depth_m, 40, 1e-9);
}

TEST(Eigenrays, LeadStraightDownAndToTheSamePlace) {
  const double g = -0.2, c0 = 1500;
  const Eigenrays rays(SoundProfile({{0, c0}, {500, c0 + 500 * g}}));
  const auto down = find(rays, {10, 210, 0, no_bottom, 0});
  ASSERT_EQ(down.size(), 1u);
  EXPECT_NEAR(down[0].travel_time_s, std::log((c0 + 210 * g) / (c0 + 10 * g)) / g, 1e-12);
  EXPECT_NEAR(down[0].launch_rad, -std::numbers::pi / 2, 1e-7);
  EXPECT_NEAR(loss_dB(down[0]), 20 * std::log10(200), 0.01);
  const auto here = find(rays, {10, 10, 0, no_bottom, 0});
  ASSERT_EQ(here.size(), 1u);
  EXPECT_EQ(here[0].travel_time_s, 0);
  EXPECT_LT(loss_dB(here[0]), 0);
}

TEST(Eigenrays, EndsBeyondTheWaterAreMovedToItsBorder) {
  const Eigenrays rays(SoundProfile({{0, 1500}, {100, 1490}}));
  const auto moved = find(rays, {-0.5, 90, 100, 50, 0}), inside = find(rays, {0, 50, 100, 50, 0});
  ASSERT_EQ(moved.size(), 1u);
  EXPECT_EQ(moved[0].travel_time_s, inside.at(0).travel_time_s);
}

TEST(SoundProfile, IsFittedUntilItIsLinearWithoutAMeanError) {
  const auto speed = [](double z) { return 1500 + 1e-3 * (z - 50) * (z - 50); };
  const SoundProfile profile = SoundProfile::fitted(speed, {}, 100, 1e-3);
  double sum = 0, worst = 0;
  for (double z = 0.05; z < 100; z += 0.1) {
    sum += profile.speed_mps(z) - speed(z);
    worst = std::max(worst, std::abs(profile.speed_mps(z) - speed(z)));
  }
  EXPECT_LT(worst, 1e-3);
  EXPECT_LT(std::abs(sum / 1000), 2e-5);
  EXPECT_LT(profile.layers(), 150u);
}

TEST(RayTables, AreMadeForEachDoublingOfTheDepth) {
  sim::RayTables tables([](double z) { return 1500 - 0.1 * z; }, {0, 30});
  EXPECT_EQ(&tables.of(51), &tables.of(99));
  EXPECT_NE(&tables.of(49), &tables.of(51));
  for (const double water_m : {1.0, 50.0, 800.0, 11999.0}) EXPECT_GT(tables.of(water_m).profile().deepest_m(), water_m);
  EXPECT_EQ(tables.of(HUGE_VAL).profile().deepest_m(), 12000);
}

}  // namespace
