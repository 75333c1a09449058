// SPDX-License-Identifier: BSD-3-Clause
#include "devices/inertial/ahrs.hpp"

#include <gmock/gmock.h>

#include "shoal/ins_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using sim::Quaterniond;
using sim::Vector3d;

std::string ahrs(const std::string& more = "") {
  return "        - {name: ahrs, type: ahrs, rate_hz: 50, phase_s: 0, truth: true" + more + "}\n";
}
const char* weightless_at_100_Hz = "{step_s: 0.01, gravity_mps2: 0}";

Quaterniond orientation(const shoal::ins_t& report) {
  return {report.quat[0], report.quat[1], report.quat[2], report.quat[3]};
}

TEST(Ahrs, ItsMessageIsTheOneOfBotCore) {
  EXPECT_EQ(static_cast<std::uint64_t>(shoal::ins_t::getHash()), 0x88a7df61422b0840u);
}

TEST(Ahrs, GivesTheAttitudeOfItsMounting) {
  test::TestWorld test(test::box_world(ahrs(", rpy_deg: [10, 20, 30]"), weightless_at_100_Hz));
  test.world.vehicles()[0]->body("hull").set_velocity_W({0, 0, 0}, {0, 0, 0.5});
  test::Listener<shoal::ins_t> reports(test, "r1.ahrs");
  test.run_for(1);
  const auto report = reports.last();
  // It has turned about up by 100 steps of 2 atan(w h / 2).
  const double yaw = 100 * 2 * std::atan(0.5 * 0.01 / 2) + sim::degrees_to_radians(30);
  const sim::Matrix3d expected =
      sim::rotation_from_rpy({sim::degrees_to_radians(10), sim::degrees_to_radians(20), yaw});
  EXPECT_NEAR((orientation(report).toRotationMatrix() - expected).norm(), 0, 1e-9);
  const Vector3d w_S = expected.transpose() * Vector3d(0, 0, 0.5);
  EXPECT_NEAR((Vector3d(report.gyro) - w_S).norm(), 0, 1e-5);  // the mean of ODE's turns is w (1 - (w h)^2 / 12)
  EXPECT_NEAR(Vector3d(report.accel).norm(), 0, 1e-9);
  EXPECT_EQ(report.device_time, report.utime);
  EXPECT_TRUE(std::isnan(report.mag[0]) && std::isnan(report.pressure) && std::isnan(report.rel_alt));
}

TEST(Ahrs, ErrorsTurnTheAttitudeInTheWorld) {
  test::TestWorld test(test::box_world(
      ahrs(", rpy_deg: [0, 0, 90], tilt_noise: {bias: 0.01}, heading_noise: {bias: 0.02}"), weightless_at_100_Hz));
  test::Listener<shoal::ins_t> reports(test, "r1.ahrs");
  test::Listener<shoal::ins_t> truths(test, "r1.ahrs.truth");
  test.run_for(0.1);
  const Quaterniond error_W = orientation(reports.last()) * orientation(truths.last()).conjugate();
  EXPECT_NEAR((devices::rotation_vector(error_W) - Vector3d(0.01, 0.01, 0.02)).norm(), 0, 1e-12);
}

TEST(Ahrs, TheHeadingDriftsSteadily) {
  test::TestWorld test(test::box_world(ahrs(", heading_drift_deg_per_h: 36"), weightless_at_100_Hz));
  test::Listener<shoal::ins_t> reports(test, "r1.ahrs");
  test.run_for(100.01);
  // 36 deg/h are 0.01 deg/s; the first sample is at 0.02 s, the last at 100.
  const double yaw = sim::yaw_of(orientation(reports.last()).toRotationMatrix());
  EXPECT_NEAR(yaw, sim::degrees_to_radians(99.98 * 0.01), 1e-9);
}

TEST(Ahrs, SlowErrorsHaveTheSpreadAskedFor) {
  test::TestWorld test(test::box_world(
      ahrs(", tilt_noise: {gauss_markov_std: 0.005, gauss_markov_time_s: 0.1}, heading_noise: {gaussian_std: 0.02}"),
      weightless_at_100_Hz));
  test::Listener<shoal::ins_t> reports(test, "r1.ahrs");
  test.run_for(200);
  double tilt = 0, heading = 0;
  const auto all = reports.take_all();
  const auto n = static_cast<double>(all.size());
  for (const auto& report : all) {
    const Vector3d error = devices::rotation_vector(orientation(report));
    tilt += (error.x() * error.x() + error.y() * error.y()) / (2 * n);
    heading += error.z() * error.z() / n;
  }
  // The squares of a Gauss-Markov process forget within T / 2: 2 axes * 200 s / 0.1 s independent ones.
  EXPECT_NEAR(std::sqrt(tilt), 0.005, 4 * 0.005 / std::sqrt(2 * 2 * 200 / 0.1));
  EXPECT_NEAR(std::sqrt(heading), 0.02, 4 * 0.02 / std::sqrt(2 * n));
}

TEST(Ahrs, RefusesANegativeSpread) {
  try {
    test::TestWorld test(test::box_world(ahrs(", tilt_noise: {gaussian_std: -1}")));
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("'gaussian_std' must be >= 0, got -1"));
  }
}

}  // namespace
