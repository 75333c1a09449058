// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "shoal/helm_command_t.hpp"
#include "shoal/thrust_rudder_elevator_command_t.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

std::string naive_world(const std::string& keys, const std::string& medium = "medium: {water: {}}\n",
                        const std::string& body = "kinematic: true") {
  return "shoal: 1\nphysics: {step_s: 0.02}\n" + medium + R"(vehicles:
  - name: a
    position_m: [0, 0, -10]
    model:
      shoal: 1
      vehicle: naive
      bodies: [{name: hull, )" +
         body + R"(, parts: [{shape: sphere, radius_m: 0.2, mass_kg: 1}]}]
      devices: [{name: drive, type: naive_drive)" +
         keys + "}]\n";
}

class NaiveDrive : public ::testing::Test {
 protected:
  void start(const std::string& keys, const std::string& medium = "medium: {water: {}}\n") {
    test = std::make_unique<test::TestWorld>(naive_world(keys, medium));
  }
  void helm(double speed, double heading, double depth, double altitude = nothing) {
    shoal::helm_command_t command{0, speed, heading, depth, altitude};
    test->send("a.drive.cmd", command);
  }
  void controls(double thrust, double rudder, double elevator) {
    test->send("a.drive.cmd", shoal::thrust_rudder_elevator_command_t{0, thrust, rudder, elevator});
  }
  sim::Pose pose() const { return test->world.vehicles()[0]->X_WV(); }
  sim::Vector3d velocity() const { return test->world.vehicles()[0]->base().v_WB_W(); }
  std::unique_ptr<test::TestWorld> test;
};

TEST_F(NaiveDrive, ReachesItsSpeedAsAFirstOrderLagDoes) {
  start(", max_speed_mps: 2, speed_time_constant_s: 4");
  controls(1, 0, 0);
  test->run_for(4);
  // In discrete steps with the exact share the speed at the end of a step is that of the closed form.
  EXPECT_NEAR(velocity().x(), 2 * (1 - std::exp(-1.0)), 1e-9);
}

TEST_F(NaiveDrive, TurnsAtTheRateOfItsRudderAndAsFastAsItMoves) {
  start(
      ", max_speed_mps: 2, speed_time_constant_s: 0, turn_time_constant_s: 0, max_turn_rate_degps: 20, "
      "steerage_speed_mps: 4");
  controls(1, 0.5, 0);
  test->run_for(3);
  // Half the rudder at half the steerage speed: a quarter of 20 deg/s, over 3 s.
  EXPECT_NEAR(sim::radians_to_degrees(sim::yaw_of(pose().linear())), 15, 1e-9);
  EXPECT_NEAR(test->world.vehicles()[0]->base().w_WB_W().z(), sim::degrees_to_radians(5), 1e-12);
}

TEST_F(NaiveDrive, ItsRudderTurnsTheOtherWayAsternAlsoOnTheSpot) {
  for (const char* steerage : {"", ", steerage_speed_mps: 1"}) {
    start(std::string(", max_speed_mps: 2, max_astern_mps: 2, speed_time_constant_s: 0, turn_time_constant_s: 0") +
          steerage);
    controls(1, 1, 0);
    test->run_for(1);
    EXPECT_GT(sim::yaw_of(pose().linear()), 0.1) << steerage;
    start(std::string(", max_speed_mps: 2, max_astern_mps: 2, speed_time_constant_s: 0, turn_time_constant_s: 0") +
          steerage);
    controls(-1, 1, 0);
    test->run_for(1);
    EXPECT_LT(sim::yaw_of(pose().linear()), -0.1) << steerage;
  }
}

TEST_F(NaiveDrive, TurnsByItsRudderAgainWhenItHasStoppedGoingAstern) {
  start(
      ", max_speed_mps: 2, max_astern_mps: 2, speed_time_constant_s: 1, turn_time_constant_s: 0, steerage_speed_mps: "
      "0");
  controls(-1, 0, 0);
  test->run_for(5);
  controls(0, 1, 0);
  test->run_for(10);  // 1e-4 m/s astern
  const double yaw_rad = sim::yaw_of(pose().linear());
  test->run_for(0.1);
  EXPECT_GT(sim::wrap_angle(sim::yaw_of(pose().linear()) - yaw_rad), 0);
}

TEST_F(NaiveDrive, HoldsHeadingAndDepth) {
  start(", max_pitch_deg: 30");
  helm(1.5, std::numbers::pi / 2, 25);
  test->run_for(90);
  EXPECT_NEAR(sim::yaw_of(pose().linear()), std::numbers::pi / 2, 1e-3);
  EXPECT_NEAR(pose().translation().z(), -25, 0.01);
  EXPECT_NEAR(velocity().norm(), 1.5, 1e-3);
}

TEST_F(NaiveDrive, GoesDownNoSteeperThanItsPitchAllows) {
  start(", max_pitch_deg: 30, speed_time_constant_s: 0, start_speed_mps: 2, depth_gain_per_s: 10");
  helm(nothing, nothing, 100);
  test->run_for(1);
  EXPECT_NEAR(velocity().z(), -2 * std::sin(sim::degrees_to_radians(30)), 1e-9);
  EXPECT_NEAR(velocity().norm(), 2, 1e-9);
  EXPECT_NEAR(std::asin(pose().linear()(2, 0)), -sim::degrees_to_radians(30), 1e-9) << "nose down";
}

TEST_F(NaiveDrive, DriftsWithTheCurrentAndOnlyWhenItIsCommandedTo) {
  const std::string flow = "medium: {water: {}, current: {velocity_mps: [0.5, -0.25, 0]}}\n";
  start("", flow);
  test->run_for(10);
  EXPECT_NEAR((pose().translation() - sim::Vector3d(5, -2.5, -10)).norm(), 0, 1e-9);
  start(", drifts: false", flow);
  test->run_for(10);
  EXPECT_NEAR((pose().translation() - sim::Vector3d(0, 0, -10)).norm(), 0, 1e-12);
}

TEST_F(NaiveDrive, RisesWhenNoOneRequestsADepthAndStaysAtTheSurface) {
  start(", rise_mps: 0.5");
  test->run_for(4);
  EXPECT_NEAR(pose().translation().z(), -8, 1e-9);
  test->run_for(120);
  EXPECT_NEAR(pose().translation().z(), 0, 0.01);
}

TEST_F(NaiveDrive, LevelsOutBelowTheSurfaceWithItsElevatorUp) {
  start(", start_speed_mps: 2, depth_gain_per_s: 0.2");
  controls(1, 0, -1);
  for (int i = 0; i < 100; ++i) {
    test->run_for(1);
    ASSERT_LE(pose().translation().z(), 0) << i << " s";
  }
  // The last meters go as exp(-0.2 t), of which 60 s leave less than a millimeter.
  EXPECT_NEAR(pose().translation().z(), 0, 1e-3);
  EXPECT_NEAR(std::asin(pose().linear()(2, 0)), 0, 1e-3);
  EXPECT_NEAR(velocity().x(), 2, 1e-3);
}

TEST_F(NaiveDrive, ADepthAboveTheSurfaceIsTheSurface) {
  start("");
  helm(2, 0, -30);
  test->run_for(90);
  EXPECT_NEAR(pose().translation().z(), 0, 1e-3);
}

TEST_F(NaiveDrive, StaysInTheWaterAmongWaves) {
  start(", rise_mps: 0.5", "medium: {water: {}, waves: {type: regular, height_m: 2, period_s: 6}}\n");
  controls(1, 0, -1);
  test->run_for(30);
  for (int i = 0; i < 200; ++i) {
    const sim::Time before = test->world.now();
    const sim::Vector3d place = pose().translation();
    test->run_for(0.02);
    const double surface_m = test->world.medium().surface_m(place.x(), place.y(), before);
    ASSERT_LE(pose().translation().z(), surface_m + 1e-9) << i;
    ASSERT_GT(pose().translation().z(), -4) << i;
  }
}

TEST_F(NaiveDrive, CountsItsDepthFromTheStillSurfaceWithoutTheTide) {
  // High water at the start: 5 m over the still surface at 2 m.
  start("", "medium: {water: {surface_m: 2}, tides: [{amplitude_m: 5}]}\n");
  helm(2, 0, 20);
  test->run_for(120);
  EXPECT_GT(test->world.medium().surface_m(0, 0), 6);
  EXPECT_NEAR(pose().translation().z(), -18, 0.01);
}

TEST_F(NaiveDrive, ASurfaceCraftLiesInTheSurface) {
  start(", surface: true, start_speed_mps: 1", "medium: {water: {surface_m: 3}}\n");
  test->run_for(2);
  EXPECT_NEAR(pose().translation().z(), 3, 1e-12);
  helm(1, 0, 5);
  helm(1, 0, nothing, 3);
  test->run_for(0.1);
  EXPECT_EQ(test->world.counts().bad_messages, 2) << "neither a depth nor an altitude";
}

TEST_F(NaiveDrive, ContinuesFromWhereSomeOnePutIt) {
  start(", start_speed_mps: 1");
  test->run_for(1);
  test->world.editor().move_vehicle("a", sim::make_pose({100, 0, -5}, {0, 0, std::numbers::pi / 2}));
  test->run_for(1);
  EXPECT_NEAR((pose().translation() - sim::Vector3d(100, 1, -5)).norm(), 0, 1e-9);
}

TEST_F(NaiveDrive, StopsWhenItIsMadeSafe) {
  start(", speed_time_constant_s: 0, watchdog_s: 1");
  controls(1, 1, 1);
  test->run_for(0.5);
  EXPECT_NEAR(velocity().norm(), 2, 1e-9);
  test->run_for(1.5);
  EXPECT_NEAR(velocity().norm(), 0, 1e-9);
}

TEST_F(NaiveDrive, SaysWhatIsWrongWithItsParameters) {
  EXPECT_THAT(test::error_of_world(naive_world(", max_speed_mps: -1")),
              ::testing::HasSubstr("'max_speed_mps' must be > 0"));
  EXPECT_THAT(test::error_of_world(naive_world("", "", "kinematic: false")),
              ::testing::HasSubstr("its body must have 'kinematic: true'"));
  EXPECT_THAT(test::error_of_world(naive_world("}, {name: second, type: naive_drive")),
              ::testing::HasSubstr("its body is already moved by device 'second'"));
  EXPECT_THAT(test::error_of_world(naive_world(", heading_gain_per_s: 10, turn_time_constant_s: 0.5")),
              ::testing::HasSubstr("'heading_gain_per_s' times 'turn_time_constant_s' must be <= 4, got 5"));
}

TEST_F(NaiveDrive, PushesWhatIsFree) {
  test = std::make_unique<test::TestWorld>(
      naive_world(", start_speed_mps: 1",
                  "objects: [{name: ball, position_m: [1, 0, -10], parts: [{shape: sphere, "
                  "radius_m: 0.2, mass_kg: 1}]}]\n") +
      "");
  test->world.physics().set_gravity(0);
  test->run_for(3);
  EXPECT_NEAR(pose().translation().x(), 3, 1e-9);
  EXPECT_GT(test->world.find_object("ball")->base().X_WB().translation().x(), 3.3);
}

}  // namespace
