// SPDX-License-Identifier: BSD-3-Clause
#include "sim/medium/wind.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "sim/bus/in_process_bus.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/sim/medium/log_capture.hpp"
#include "tests/sim/medium/medium_worlds.hpp"
#include "tests/state_hash_of.hpp"

namespace {

using sim::Time;
using sim::Vector3d;
using test_support::make_medium;

TEST(Wind, GrowsWithTheHeight) {
  const sim::Medium power = make_medium("wind: {speed_mps: 10, direction_deg: 90, profile: power, exponent: 0.12}");
  EXPECT_NEAR(power.air_velocity_W({0, 0, 10}).y(), 10, 1e-9);
  EXPECT_NEAR(power.air_velocity_W({0, 0, 2}).y(), 10 * std::pow(0.2, 0.12), 1e-9);
  const sim::Medium log = make_medium("wind: {velocity_mps: [10, 0, 0], profile: log, roughness_m: 0.001}");
  EXPECT_NEAR(log.air_velocity_W({0, 0, 1}).x(), 7.5, 1e-9);  // ln(1000) / ln(10000)
  EXPECT_EQ(log.air_velocity_W({0, 0, -1}).norm(), 0);
}

TEST(Wind, ComesFromWhereForecastsSay) {
  const sim::Medium medium = make_medium("wind: {speed_mps: 8, from_compass_deg: 270}");
  EXPECT_TRUE(medium.air_velocity_W({0, 0, 10}).isApprox(Vector3d(8, 0, 0), 1e-12));  // a west wind blows to the east
  const sim::Medium north = make_medium("wind: {speed_mps: 8, from_compass_deg: 0}");
  EXPECT_TRUE(north.air_velocity_W({0, 0, 10}).isApprox(Vector3d(0, -8, 0), 1e-12));
}

TEST(Wind, GustsHaveTheirDeviationAlongAndAcross) {
  sim::Medium medium =
      make_medium("wind: {speed_mps: 10, direction_deg: 90, gusts: {std_mps: 2, across_std_mps: 1, length_m: 50}}");
  double along = 0, across = 0;
  constexpr int samples = 40000;
  for (int i = 0; i < samples; ++i) {
    medium.advance_to(Time{std::int64_t{i} * 1000000});
    const Vector3d v_W = medium.air_velocity_W({0, 0, 10});
    along += (v_W.y() - 10) * (v_W.y() - 10);
    across += v_W.x() * v_W.x();
  }
  // T = 5 s, two of them apart: 8e3 independent samples, 1.6 % of the variance, 1 % between ticks; tolerance 4 %.
  EXPECT_NEAR(std::sqrt(along / samples), 2, 0.08);
  EXPECT_NEAR(std::sqrt(across / samples), 1, 0.04);
}

TEST(Wind, ADryWorldHasItToo) {
  sim::Medium medium = make_medium("wind: {gusts: {}}"), later = make_medium("wind: {gusts: {}}");
  const std::uint64_t before = test::state_hash_of(medium);
  later.advance_to(Time{1000000});
  EXPECT_NE(before, test::state_hash_of(later));
}

}  // namespace
