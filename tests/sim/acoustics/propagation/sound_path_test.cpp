// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/propagation/sound_path.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "tests/fidelity/closed_forms.hpp"
#include "tests/sim/medium/medium_worlds.hpp"

namespace {

using sim::Medium;
using sim::Time;
using sim::Vector3d;
using test_support::make_medium;

Medium water_of(double c_mps) {
  return make_medium("water: {sound_speed_mps: " + std::to_string(c_mps) + "}");
}

/// 1500 m/s at the surface, `gradient` more with every meter of depth, down to 2 km.
Medium linear_water(double gradient) {
  return make_medium("water: {profile: [{depth_m: 0, sound_speed_mps: 1500}, {depth_m: 2000, sound_speed_mps: " +
                     std::to_string(1500 + 2000 * gradient) + "}]}");
}

const char* const kinked = R"(
water:
  profile:
    - {depth_m: 0, temperature_C: 18, salinity_psu: 34}
    - {depth_m: 33, temperature_C: 17, salinity_psu: 34}
    - {depth_m: 47, temperature_C: 9, salinity_psu: 35}
    - {depth_m: 300, temperature_C: 5, salinity_psu: 35}
)";

TEST(SoundPath, TakesTheTimeOfTheReferenceInUniformWater) {
  for (const auto& form : test::closed_forms_of("one_way_travel_time")) {
    const double d_m = form.at("distance");
    const Vector3d from(10, -20, -5), to = from + d_m * Vector3d(0.6, 0.64, -0.48);
    test::expect_closed_form(sim::travel_time_s(water_of(form.at("c")), from, to), form);
    EXPECT_NEAR(sim::travel_time_s(water_of(form.at("c")), from, to), d_m / form.at("c"), 1e-12);
  }
}

TEST(SoundPath, IsExactOnTheStraightLineThroughALinearGradient) {
  // The mean of 1 / c over a linear c is ln(c2 / c1) / (c2 - c1).
  const Medium medium = linear_water(0.1);
  const Vector3d a(0, 0, -35), b(800, 0, -1220);
  const double c1 = 1503.5, c2 = 1622;
  EXPECT_NEAR(sim::travel_time_s(medium, a, b), (b - a).norm() * std::log(c2 / c1) / (c2 - c1), 1e-13);
}

TEST(SoundPath, IsTheMeanThroughAnyProfile) {
  const Medium medium = make_medium(kinked);
  const auto fine = [&](double z1, double z2) {
    double sum = 0;
    for (int i = 0; i < 200000; ++i) sum += 1 / medium.sound_speed_mps({0, 0, z1 + (z2 - z1) * (i + 0.5) / 200000});
    return sum / 200000;
  };
  for (const double end_m : {-12.0, -40.0, -46.99, -47.01, -300.0, -2500.0}) {
    const Vector3d a(0, 0, -1), b(30, 40, end_m);
    const double length_m = (b - a).norm(), time_s = sim::travel_time_s(medium, a, b);
    EXPECT_NEAR(time_s, length_m * fine(-1, end_m), 1e-10 * time_s) << end_m;
  }
}

TEST(SoundPath, TheStraightLineIsNearTheTrueRayOverTheRangesOfModems) {
  // In a linear gradient g rays are arcs of circles; level ends: t = 2/g asinh(g L / 2 c), less than the straight
  // line's by L^3 g^2 / (24 c^3) to first order; the next is 6e-5 of it.  At 2 km in the gradient of the deep sea,
  // 0.017/s: 29 us, 4 cm.
  const double g = 0.017, L = 2000, c = 1500 + g * 500;
  const double ray_s = 2 / g * std::asinh(g * L / (2 * c));
  const double straight_s = sim::travel_time_s(linear_water(g), {0, 0, -500}, {L, 0, -500});
  EXPECT_NEAR(straight_s - ray_s, L * L * L * g * g / (24 * c * c * c), 2e-9);
  EXPECT_LT((straight_s - ray_s) * c, 0.05);
}

RC_GTEST_PROP(SoundPath, TakesAsLongBack, ()) {
  static const Medium medium = make_medium(kinked);
  const auto point = [] {
    const auto part = [](int low, int high) { return *rc::gen::inRange(low, high) * 0.01; };
    return Vector3d(part(-100000, 100000), part(-100000, 100000), part(-40000, 100));
  };
  const Vector3d a = point(), b = point();
  const double there_s = sim::travel_time_s(medium, a, b);
  RC_ASSERT(std::abs(there_s - sim::travel_time_s(medium, b, a)) <= 1e-15 * there_s);
}

TEST(SoundPath, MeetsAReceiverThatRunsAwayComesNearOrCrosses) {
  const Medium medium = water_of(1500);
  const Vector3d source(0, 0, -20), at(1200, 0, -20);
  const auto time_s = [&](const Vector3d& v) { return sim::meeting(medium, source, at, v)->travel_time_s; };
  EXPECT_NEAR(time_s({0, 0, 0}), 0.8, 1e-12);
  EXPECT_NEAR(time_s({5, 0, 0}), 1200.0 / 1495, 1e-9);
  EXPECT_NEAR(time_s({-5, 0, 0}), 1200.0 / 1505, 1e-9);
  EXPECT_NEAR(time_s({0, 30, 0}), 1200 / std::sqrt(1500.0 * 1500 - 900), 1e-9);
  EXPECT_FALSE(sim::meeting(medium, source, at, {1500, 0, 0}));
  EXPECT_EQ(sim::meeting(medium, source, source, {0, 0, 0})->travel_time_s, 0);
}

TEST(SoundPath, MeetsAReceiverThatWasSeenAtAnotherTime) {
  const Medium medium = water_of(1500);
  // At 3.5 s it is at x = 700; when the sound starts, at 4 s, 2 m nearer.
  const auto seen = sim::meeting(medium, {0, 0, -20}, Time{4000000}, {700, 0, -20}, Time{3500000}, {-4, 0, 0});
  EXPECT_NEAR(seen->travel_time_s, 698.0 / 1504, 1e-9);
  EXPECT_NEAR(seen->p_W.x(), 698 - 4 * 698.0 / 1504, 1e-6);
  EXPECT_NEAR(seen->range_m, seen->p_W.x(), 1e-9);
  EXPECT_NEAR((seen->direction_W - Vector3d::UnitX()).norm(), 0, 1e-12);
}

RC_GTEST_PROP(SoundPath, MeetsWhereTheSoundIsAtThatTime, ()) {
  static const Medium medium = make_medium(kinked);
  const auto part = [](int low, int high) { return *rc::gen::inRange(low, high) * 0.01; };
  const Vector3d source(part(-1000, 1000), 0, part(-30000, -100));
  const Vector3d at(part(-300000, 300000), part(-300000, 300000), part(-30000, -100));
  const Vector3d velocity(part(-2000, 2000), part(-2000, 2000), part(-500, 500));
  const auto met = sim::meeting(medium, source, at, velocity);
  RC_ASSERT(met.has_value());
  RC_ASSERT((met->p_W - at - velocity * met->travel_time_s).norm() < 1e-9);
  RC_ASSERT(std::abs(sim::travel_time_s(medium, source, met->p_W) - met->travel_time_s) < 1e-9);
}

TEST(SoundPath, DopplerCountsBothEnds) {
  const Vector3d east = Vector3d::UnitX();
  EXPECT_EQ(sim::closing_speed_mps(east, {2, 9, 0}, {-1, 3, 0}), 3);
  EXPECT_DOUBLE_EQ(sim::doppler_factor(east, {2, 9, 0}, {-1, 3, 0}, 1500), 1501.0 / 1498);
  // Two wavefronts a second apart arrive so much closer together.
  const Medium medium = water_of(1500);
  const Vector3d v_source(2, 0, 0), v_receiver(-1, 0, 0), p_source(0, 0, -5), p_receiver(600, 0, -5);
  const double first_s = sim::meeting(medium, p_source, p_receiver, v_receiver)->travel_time_s;
  const double second_s =
      1 + sim::meeting(medium, p_source + v_source, p_receiver + v_receiver, v_receiver)->travel_time_s;
  EXPECT_NEAR(1 / (second_s - first_s), sim::doppler_factor(east, v_source, v_receiver, 1500), 1e-9);
}

TEST(SoundPath, GoesThroughAirInAWorldWithoutWater) {
  EXPECT_NEAR(sim::travel_time_s(make_medium("{}"), {0, 0, 1}, {340.3, 0, 1}), 1, 1e-12);
}

TEST(SoundPath, CountsWhatIsOverTheSurfaceAsWaterAtTheSurface) {
  const Medium medium = linear_water(0.1);
  EXPECT_NEAR(sim::travel_time_s(medium, {0, 0, 0.5}, {1500, 0, 0.5}), 1, 1e-12);
}

}  // namespace
