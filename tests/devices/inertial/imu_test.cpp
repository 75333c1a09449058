// SPDX-License-Identifier: BSD-3-Clause
#include "devices/inertial/imu.hpp"

#include <gmock/gmock.h>

#include "shoal/imu_t.hpp"
#include "tests/devices/inertial/imu_fixture.hpp"
#include "tests/devices/inertial/weightless.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace imu_fixture;

using sim::Vector3d;
using test::weightless;

TEST(Imu, TheLowPassLagsAsItsTimeConstantSays) {
  // 1 / (2 pi 1 Hz) = 0.159 s; a step of the rate at t = 0.1 s.
  test::TestWorld test(test::box_world(imu(", bandwidth_Hz: 1"), weightless));
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  test::Listener<shoal::imu_t> truths(test, "r1.imu.truth");
  test.run_for(0.1);
  hull(test).set_velocity_W({0, 0, 0}, {0, 0, 1});
  test.run_for(0.2);
  EXPECT_NEAR(gyro_of(truths.last()).z(), 1, 1e-6);
  EXPECT_NEAR(gyro_of(reports.last()).z(), 1 - std::exp(-0.2 * 2 * std::numbers::pi), 1e-6);
}

TEST(Imu, NoiseHasTheMeanAndTheSpreadAskedForAndTheTruthHasNone) {
  test::TestWorld test(test::box_world(
      imu(", gyro_noise: {gaussian_std: 0.02, bias: 0.1}, accel_noise: {gaussian_std: 0.3}"), weightless));
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  test::Listener<shoal::imu_t> truths(test, "r1.imu.truth");
  test.run_for(20);
  const auto all = reports.take_all();
  double mean = 0, gyro_squares = 0, accel_squares = 0;
  const double n = 3.0 * static_cast<double>(all.size());
  for (const auto& report : all) {
    mean += gyro_of(report).sum() / n;
    gyro_squares += (gyro_of(report) - Vector3d::Constant(0.1)).squaredNorm() / n;
    accel_squares += accel_of(report).squaredNorm() / n;
  }
  // Four standard deviations of the estimates.
  EXPECT_NEAR(mean, 0.1, 4 * 0.02 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(gyro_squares), 0.02, 4 * 0.02 / std::sqrt(2 * n));
  EXPECT_NEAR(std::sqrt(accel_squares), 0.3, 4 * 0.3 / std::sqrt(2 * n));
  for (const auto& truth : truths.take_all()) EXPECT_NEAR(gyro_of(truth).norm() + accel_of(truth).norm(), 0, 1e-12);
}

TEST(Imu, CutsAtItsRangeAndRoundsToItsResolution) {
  test::TestWorld test(test::box_world(imu(", gyro_range_dps: 100, gyro_resolution_dps: 0.5"), weightless));
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  const double degree = sim::degrees_to_radians(1);
  hull(test).set_velocity_W({0, 0, 0}, Vector3d(0, 0, 150 * degree));
  test.run_for(0.1);
  EXPECT_NEAR(gyro_of(reports.last()).z(), 100 * degree, 1e-12);
  hull(test).set_velocity_W({0, 0, 0}, Vector3d(0, 0, -20.3 * degree));
  test.run_for(0.1);
  EXPECT_NEAR(gyro_of(reports.last()).z(), -20.5 * degree, 1e-12);
}

TEST(Imu, RefusesBadParameters) {
  const auto error_of = [](const std::string& more) -> std::string {
    try {
      test::TestWorld test(test::box_world(imu(more)));
    } catch (const sim::ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(error_of(", gyro_arw_deg_per_sqrt_h: -1"),
              testing::HasSubstr("device 'imu': 'gyro_arw_deg_per_sqrt_h' must be >= 0, got -1"));
  EXPECT_THAT(error_of(", accel_bias_time_s: 0"), testing::HasSubstr("'accel_bias_time_s' must be > 0, got 0"));
  EXPECT_THAT(error_of(", preset: adis99"), testing::HasSubstr("'preset'"));
}

}  // namespace
