// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/bound/vehicle_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/devices/world_fixture.hpp"

namespace {

using Motion = experiment::VehicleErrors::Motion;

/// Errors of a vehicle of a shipped world.
experiment::VehicleErrors errors_in(const std::string& world, const std::string& vehicle) {
  const sim::LoadedWorld loaded =
      sim::load_world("worlds/" + world + ".yaml", test::LoadedTestWorld::with_messages({}));
  for (const sim::VehicleInstance& instance : loaded.config.vehicles)
    if (instance.name == vehicle) return experiment::errors_of(*instance.config, loaded.config.physics.step_s);
  throw std::runtime_error("no vehicle " + vehicle);
}

TEST(VehicleErrors, OfAnAuvAreThoseOfItsFile) {
  const experiment::VehicleErrors errors = errors_in("coop_underwater", "auv");
  EXPECT_EQ(errors.motion, Motion::measured_velocity);
  ASSERT_EQ(errors.heading.slow.size(), 2u);
  EXPECT_EQ(errors.heading.slow[0].initial_std, 0.05);
  EXPECT_EQ(errors.heading.slow[0].time_s, 0);
  EXPECT_EQ(errors.heading.slow[1].initial_std, 0.02);
  EXPECT_EQ(errors.heading.slow[1].time_s, 20);
  EXPECT_EQ(errors.speed_scale_std, 0.03);
  // Four beams at 30 degrees: 0.005 / (sqrt(2) sin 30).
  EXPECT_NEAR(errors.beam_std_mps, 0.005 * std::numbers::sqrt2, 1e-12);
  EXPECT_EQ(errors.velocity_period_s, 0.2);
  ASSERT_TRUE(errors.gps);
  EXPECT_EQ(errors.gps->position.white_std, 1);
  EXPECT_EQ(errors.clock_offset_std_s, 0.005);
  EXPECT_EQ(errors.clock_drift_std, 1e-6);
  EXPECT_EQ(errors.clock_white_fm, 1e-9);
  EXPECT_FALSE(errors.disciplined());
  ASSERT_EQ(errors.modems.size(), 1u);
  EXPECT_EQ(errors.modems[0].at_V, sim::Vector3d(0.5, 0, 0.1));
}

TEST(VehicleErrors, OfACraftAreThoseOfItsFixes) {
  const experiment::VehicleErrors errors = errors_in("coop_underwater", "boat1");
  EXPECT_EQ(errors.motion, Motion::unknown);
  ASSERT_TRUE(errors.gps);
  EXPECT_EQ(errors.gps->position.white_std, 0.3);
  EXPECT_TRUE(errors.gps->position.slow.empty());
  EXPECT_TRUE(errors.disciplined());
  EXPECT_TRUE(errors.can_navigate());
}

TEST(VehicleErrors, OfWheelsIncludeTheirCalibration) {
  const experiment::VehicleErrors errors = errors_in("coop_land", "rover3");
  EXPECT_EQ(errors.motion, Motion::wheels);
  // Wheels of 0.1 m taken for 0.1005 m, a track of 0.4 m for 0.394 m.
  EXPECT_NEAR(errors.speed_scale_std, 0.005, 1e-9);
  EXPECT_NEAR(errors.turn_scale_std, 1.005 * 0.4 / 0.394 - 1, 1e-9);
  // 20 samples a second, each with 0.006 rad of each wheel.
  EXPECT_NEAR(errors.along_noise_mprts, 0.1005 * 0.006 * std::sqrt(20.0 / 2), 1e-9);
  EXPECT_NEAR(errors.turn_noise_radprts, 0.1005 * 0.006 * std::sqrt(20.0 * 2) / 0.394, 1e-9);
  ASSERT_TRUE(errors.sightings);
  EXPECT_EQ(errors.sightings->white_std_m, 0.15);
  EXPECT_FALSE(errors.gps);
}

TEST(VehicleErrors, OfUSBLHaveThoseOfTheHeading) {
  const experiment::VehicleErrors errors = errors_in("benchmark/12_usbl_fleet", "craft1");
  ASSERT_TRUE(errors.usbl);
  EXPECT_EQ(errors.usbl->sensor.device, "usbl");
  EXPECT_EQ(errors.usbl->errors.range_std_m, 0.2);
  EXPECT_EQ(errors.usbl->errors.across_std_rad, 0.02);
  EXPECT_EQ(errors.usbl->errors.heading_std_rad, 0.01);
  EXPECT_EQ(errors.usbl->errors.elevation_std_rad, 0.02);
}

TEST(VehicleErrors, TakeAConstantErrorForAStandardDeviation) {
  sim::NoiseParams noise;
  noise.bias = 3;
  noise.bias_std = 4;
  noise.random_walk_std = 0.1;
  noise.gaussian_std = 0.3;
  noise.uniform_half_width = 0.4 * std::numbers::sqrt3;
  const experiment::QuantityErrors errors = experiment::errors_of(noise);
  EXPECT_NEAR(errors.white_std, 0.5, 1e-12);
  ASSERT_EQ(errors.slow.size(), 1u);
  EXPECT_NEAR(errors.slow[0].initial_std, 5, 1e-12);
  EXPECT_EQ(errors.slow[0].walk_std, 0.1);
}

}  // namespace
