// SPDX-License-Identifier: BSD-3-Clause
#include "devices/inertial/imu.hpp"

#include <gmock/gmock.h>

#include "devices/inertial/imu_presets.hpp"
#include "shoal/imu_t.hpp"
#include "tests/devices/inertial/weightless.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using sim::Vector3d;

std::string imu(const std::string& more = "") {
  return "        - {name: imu, type: imu, rate_hz: 100, phase_s: 0, truth: true" + more + "}\n";
}
using test::weightless;

Vector3d gyro_of(const shoal::imu_t& report) {
  return Vector3d(report.angular_velocity_radps);
}
Vector3d accel_of(const shoal::imu_t& report) {
  return Vector3d(report.linear_acceleration_mps2);
}

sim::Body& hull(test::TestWorld& test) {
  return test.world.vehicles()[0]->body("hull");
}

TEST(Imu, FeelsNothingInFreeFall) {
  test::TestWorld test(test::box_world(imu(", position_m: [0.1, 0, 0]")));
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  test.run_for(0.5);
  EXPECT_NEAR(gyro_of(reports.last()).norm(), 0, 1e-12);
  // The step adds g * dt to the velocity: 5 m/s keep 16 digits, and the difference is divided by 0.01 s.
  test.run_for(0.1);
  EXPECT_NEAR(accel_of(reports.last()).norm(), 0, 1e-12);
}

TEST(Imu, FeelsTheGroundAtRestInItsOwnAxes) {
  test::TestWorld test(test::rover_world(imu(", rpy_deg: [0, 30, 0]")));
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  test.run_for(2);
  // Nose down by 30 degrees: upwards is (-1/2, 0, sqrt(3)/2).  The rover tilts on its casters by less than 0.01 rad.
  const Vector3d f = accel_of(reports.last());
  EXPECT_NEAR(f.x(), -0.5 * 9.80665, 0.1);
  EXPECT_NEAR(f.y(), 0, 0.1);
  EXPECT_NEAR(f.z(), std::sqrt(0.75) * 9.80665, 0.1);
  EXPECT_NEAR(f.norm(), 9.80665, 1e-3);  // at rest, whichever way it tilts
}

TEST(Imu, FeelsTheGravityOfTheMoment) {
  test::TestWorld test(test::rover_world(imu()));
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  test.run_for(1);
  test.world.physics().set_gravity(1.62);
  test.run_for(2);
  EXPECT_NEAR(accel_of(reports.last()).norm(), 1.62, 1e-3);  // at rest
}

TEST(Imu, FeelsNothingInFreeFallUnderAnotherGravity) {
  test::TestWorld test(test::box_world(imu()));
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  test.run_for(0.1);
  test.world.physics().set_gravity(1.62);
  test.run_for(0.1);
  EXPECT_NEAR(accel_of(reports.last()).norm(), 0, 1e-12);
}

TEST(Imu, TheFirstSampleKnowsGravityOnly) {
  test::TestWorld test(test::box_world(imu()));
  hull(test).set_velocity_W({0, 0, 0}, {0, 0, 3});
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  test.run_for(0.01);
  const auto report = reports.last();
  EXPECT_NEAR((gyro_of(report) - Vector3d(0, 0, 3)).norm(), 0, 1e-12);
  EXPECT_NEAR((accel_of(report) - Vector3d(0, 0, 9.80665)).norm(), 0, 1e-12);
}

TEST(Imu, FeelsTheCentripetalForceAtItsLeverArm) {
  test::TestWorld test(test::box_world(imu(", position_m: [0.5, 0, 0]"), weightless));
  hull(test).set_velocity_W({0, 0, 0}, {0, 0, 2});
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  test.run_for(0.5);
  const auto report = reports.last();
  // ODE turns by 2 atan(w h / 2) in a step; ten steps in a sample.  The mean of the centripetal acceleration over an
  // arc is the chord of the velocities: 2 w r sin(angle / 2) / dt, half-way.
  const double angle = 10 * 2 * std::atan(2 * 0.001 / 2);
  EXPECT_NEAR((gyro_of(report) - Vector3d(0, 0, angle / 0.01)).norm(), 0, 1e-10);
  EXPECT_NEAR((accel_of(report) - Vector3d(-2 * 2 * 0.5 * std::sin(angle / 2) / 0.01, 0, 0)).norm(), 0, 1e-10);
  EXPECT_NEAR(accel_of(report).x(), -4 * 0.5, 1e-3);  // -w^2 r
}

TEST(Imu, DoesNotFeelThatItsVehicleIsPutElsewhere) {
  test::TestWorld test(test::rover_world(imu()));
  test.run_for(2);
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  const sim::Pose X_move_W = sim::make_pose({3, 4, 0}, {0, 0, sim::degrees_to_radians(90)});
  test.world.editor().move_vehicle("r1", X_move_W * test.world.find_vehicle("r1")->X_WV());
  test.run_for(0.5);
  for (const auto& report : reports.take_all()) {
    EXPECT_LT(gyro_of(report).norm(), 1e-3);
    EXPECT_NEAR(accel_of(report).norm(), 9.80665, 1e-3);  // at rest, as before
  }
}

TEST(Imu, DoesNotFeelThatAMoveStopsItsVehicle) {
  test::TestWorld test(test::box_world(imu(), weightless));
  hull(test).set_velocity_W({1, 0, 0}, {0, 0, 2});
  test.run_for(0.1);
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  test.world.editor().move_vehicle("r1", sim::make_pose({3, 4, 0}, {0, 0, 1.5}));
  test.run_for(0.1);
  for (const auto& report : reports.take_all()) EXPECT_NEAR(gyro_of(report).norm() + accel_of(report).norm(), 0, 1e-9);
}

TEST(Imu, ItsRatesAddUpToTheAttitude) {
  test::TestWorld test(test::box_world(imu(), weightless));
  hull(test).set_velocity_W({0, 0, 0}, {1, 4, 2});  // tumbles: three different moments of inertia
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  test.run_for(0.01);
  sim::Quaterniond q(hull(test).X_WB().linear());
  reports.take_all();
  test.run_for(5);
  const auto all = reports.take_all();
  ASSERT_EQ(all.size(), 500u);
  for (const auto& report : all) q = q * devices::rotation_of(gyro_of(report) * 0.01);
  // 500 products of rotations, each right to rounding.
  EXPECT_LT(q.angularDistance(sim::Quaterniond(hull(test).X_WB().linear())), 1e-10);
}

TEST(Imu, AForceThroughTheMiddleIsFeltAsAcceleration) {
  test::TestWorld test(test::box_world(imu(), weightless));
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  for (int i = 0; i < 100; ++i) {
    hull(test).add_force_W({3, 0, 0}, hull(test).X_WB().translation());
    test.world.step();
  }
  EXPECT_NEAR((accel_of(reports.last()) - Vector3d(3, 0, 0)).norm(), 0, 1e-10);  // 3 N on 1 kg
}

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

TEST(Imu, AKeyWinsOverThePreset) {
  test::TestWorld test(test::box_world(imu(", preset: vn100, gyro_arw_deg_per_sqrt_h: 0"), weightless));
  const auto& sensor = dynamic_cast<const devices::Imu&>(*test.world.find_device("r1/imu")->sensor());
  // The alignment of the preset is there.
  EXPECT_NE(sensor.gyro_errors().matrix(), sim::Matrix3d::Identity());
  test::Listener<shoal::imu_t> reports(test, "r1.imu");
  test.run_for(2);
  const auto all = reports.take_all();
  // Without the white noise two samples differ by the slow part only: 5 deg/h / 0.617 * sqrt(2 * 0.01 s / 100 s)
  // = 5.6e-7 rad/s; with it by 8.6e-4 rad/s.
  for (std::size_t i = 1; i < all.size(); ++i)
    EXPECT_LT((gyro_of(all[i]) - gyro_of(all[i - 1])).norm(), 5 * std::sqrt(3.0) * 5.6e-7);
  EXPECT_NE(gyro_of(all[1]), gyro_of(all[0]));
}

TEST(Imu, PresetsHoldTheFiguresOfTheDataSheetsInSi) {
  const auto find = [](const std::string& name) {
    for (const auto& preset : devices::imu_presets())
      if (preset.name == name) return preset;
    throw std::runtime_error(name);
  };
  // 0.34 deg/sqrt(h) = 0.34 / 60 deg/sqrt(s), and the sheet's 0.008 deg/s/sqrt(Hz) is about 1.4 times that.
  EXPECT_NEAR(find("adis16470").gyro.random_walk, 9.890e-5, 1e-8);
  EXPECT_NEAR(find("adis16470").accel.bias_instability, 1.275e-4, 1e-7);
  EXPECT_NEAR(find("vn100").gyro.random_walk, 6.109e-5, 1e-8);
  EXPECT_NEAR(find("vn100").accel.random_walk, 1.373e-3, 1e-6);
  EXPECT_NEAR(find("stim300").gyro.bias_instability, 2.424e-6, 1e-9);
  EXPECT_NEAR(find("stim300").accel.random_walk, 1.167e-3, 1e-6);
  EXPECT_NEAR(find("bmi088").gyro.random_walk, 0.84 * devices::unit::deg_per_sqrt_h, 1e-10);
  EXPECT_NEAR(find("bmi088").accel.random_walk, 2.256e-3, 1e-6);
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
