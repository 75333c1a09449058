// SPDX-License-Identifier: BSD-3-Clause
#include "devices/inertial/strapdown.hpp"

#include <gmock/gmock.h>

#include "devices/inertial/imu.hpp"
#include "shoal/imu_t.hpp"
#include "tests/devices/inertial/imu_fixture.hpp"
#include "tests/devices/inertial/weightless.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using namespace imu_fixture;

using sim::Vector3d;
using test::weightless;

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

}  // namespace
