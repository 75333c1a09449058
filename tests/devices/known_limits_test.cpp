// SPDX-License-Identifier: BSD-3-Clause
// What docs/reference/known_limits.md says that Shoal does not do, where no other test shows it.  Such a test fails
// when the limit is gone: mend the page then.

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "shoal/acoustic_received_t.hpp"
#include "shoal/actuator_command_t.hpp"
#include "shoal/compass_t.hpp"
#include "shoal/gps_data_t.hpp"
#include "shoal/imu_t.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/range_beacon_t.hpp"
#include "shoal/wrench_t.hpp"
#include "sim/world/world_editor.hpp"
#include "tests/devices/comms/modem_fixture.hpp"
#include "tests/devices/marine/marine_fixture.hpp"
#include "tests/devices/navigation/immersed_sensor_fixture.hpp"

namespace {

using sim::Vector3d;
using test::TestWorld;
using test::wet_device;
using test::WetBox;

constexpr double pi = std::numbers::pi;

TestWorld water(const std::string& medium) {
  return TestWorld("shoal: 1\nmedium: {water: {}, " + medium + "}\n");
}

/// A ball with a radius of 2 cm flies at a plate of 2 cm, in steps of 10 ms.
double place_of_a_ball(double speed_mps) {
  TestWorld test(R"(
shoal: 1
physics: {step_s: 0.01, gravity_mps2: 0}
objects:
  - {name: plate, fixed: true, parts: [{shape: box, size_m: [0.02, 2, 2]}]}
  - {name: ball, position_m: [-0.55, 0, 0], parts: [{shape: sphere, radius_m: 0.02, mass_kg: 0.1}]}
)");
  sim::Body& ball = test.world.find_object("ball")->base();
  ball.set_velocity_W({speed_mps, 0, 0}, Vector3d::Zero());
  test.run_for(2 / speed_mps);
  return ball.X_WB().translation().x();
}

TEST(KnownLimits, ASmallFastBodyPassesThroughAThinPlate) {
  // 2 m/s move it by 2 cm in a step, less than half the plate and the radius: 3 cm.
  EXPECT_LT(place_of_a_ball(2), 0);
  EXPECT_NEAR(place_of_a_ball(10), 2 - 0.55, 0.11);  // a step of 10 cm
}

TEST(KnownLimits, APendulumOnAJointLosesEnergyInLongSteps) {
  const auto swing_deg = [](const char* step_s) {
    TestWorld test(std::string("shoal: 1\nphysics: {step_s: ") + step_s + R"(}
vehicles:
  - name: v
    model:
      shoal: 1
      vehicle: pendulum
      bodies: [{name: bob, position_m: [0.8660254, 0, -0.5], parts: [{shape: sphere, radius_m: 0.05, mass_kg: 1}]}]
      joints: [{name: hinge, type: hinge, bodies: [bob, world], anchor_m: [0, 0, 0], axis: [0, 1, 0]}]
)");
    const sim::Body& bob = test.world.vehicles()[0]->body("bob");
    double widest = 0;
    while (sim::to_seconds(test.world.now()) < 20) {
      test.world.step();
      const Vector3d& p = bob.X_WB().translation();
      if (sim::to_seconds(test.world.now()) > 17) widest = std::max(widest, std::abs(std::atan2(p.x(), -p.z())));
    }
    return sim::radians_to_degrees(widest);
  };
  EXPECT_NEAR(swing_deg("0.001"), 60, 0.1);
  EXPECT_LT(swing_deg("0.01"), 59.5);  // 53.5 after 100 s
}

TEST(KnownLimits, PartsThatOverlapDisplaceWaterTwice) {
  // Two balls in one place: 113 l each, of 170 kg together.
  for (const bool twice : {true, false}) {
    TestWorld test(R"(
shoal: 1
medium: {water: {density_kgpm3: 1000}}
objects:
  - name: it
    position_m: [0, 0, -10]
    parts: [{shape: sphere, radius_m: 0.3, mass_kg: 170}, {shape: sphere, radius_m: 0.3, displaces: )" +
                   std::string(twice ? "true" : "false") + "}]\n");
    test.run_for(1);
    EXPECT_EQ(test.world.find_object("it")->base().v_WB_W().z() > 0, twice);
  }
}

TEST(KnownLimits, WaterFlowsOnAverageAgainstAWave) {
  TestWorld test = water("waves: {type: regular, height_m: 1, period_s: 5, direction_deg: 0}");
  const double omega = 2 * pi / 5, k = omega * omega / 9.80665;
  for (const double depth_m : {2.0, 10.0}) {
    double sum = 0;
    for (int step = 0; step < 500; ++step) {  // a period
      test.world.step();
      sum += test.world.medium().water_velocity_W({0, 0, -depth_m}).x();
    }
    const double expected = -0.25 * omega * k * std::exp(-k * depth_m) / 2;
    EXPECT_NEAR(sum / 500, expected, 0.03 * std::abs(expected)) << depth_m;  // up to terms of the next order
  }
}

TEST(KnownLimits, ACurrentLeavesWavesAsTheyAre) {
  const std::string waves = "waves: {type: regular, height_m: 1, period_s: 5}";
  TestWorld still = water(waves), flowing = water(waves + ", current: {velocity_mps: [2, 1, 0]}");
  for (TestWorld* test : {&still, &flowing}) test->run_for(3);
  EXPECT_NE(still.world.medium().surface_m(20, 7), 0);
  EXPECT_EQ(still.world.medium().surface_m(20, 7), flowing.world.medium().surface_m(20, 7));
}

TEST(KnownLimits, WindMovesNoWaterAndAirIsTheSameAtEveryHeight) {
  TestWorld test = water("wind: {speed_mps: 20}");
  test.run_for(1);
  const sim::Medium& medium = test.world.medium();
  EXPECT_EQ(medium.surface_m(3, 4), 0);
  EXPECT_EQ(medium.water_velocity_W({3, 4, -0.1}), Vector3d::Zero());
  EXPECT_EQ(medium.density_kgpm3({0, 0, 5000}), medium.density_kgpm3({0, 0, 1}));
  EXPECT_EQ(medium.pressure_Pa({0, 0, 5000}), medium.pressure_Pa({0, 0, 1}));
}

TEST(KnownLimits, WaterOfACurrentThatChangesHasNoAcceleration) {
  TestWorld test = water("current: {type: gauss_markov, speed_mps: 1, std_mps: 0.5, correlation_time_s: 2}");
  const Vector3d p(0, 0, -5), before = test.world.medium().water_velocity_W(p);
  test.run_for(1);
  EXPECT_NE(test.world.medium().water_velocity_W(p), before);
  EXPECT_EQ(test.world.medium().water_at(p).acceleration_W, Vector3d::Zero());
}

TEST(KnownLimits, APropellerHasNoInflowAsternAndFromBehind) {
  const std::string remus = wet_device(
      "type: thruster, command: rpm, max: 1525, curve: kt_kq, diameter_m: 0.14, k_t0: 0.4566, "
      "k_t_slope: 0.41737033, k_q0: 0.07, k_q_slope: 0.05850422");
  const auto thrust = [&](double rpm, double speed_mps) {
    WetBox box(remus);
    box.set_velocity({speed_mps, 0, 0});
    box.command(rpm);
    return box.force_W().x();
  };
  EXPECT_LT(thrust(1525, 1), 0.9 * thrust(1525, 0));
  EXPECT_NEAR(thrust(1525, -1), thrust(1525, 0), 1e-9);
  EXPECT_NEAR(thrust(-1525, -1), thrust(-1525, 0), 1e-9);
  EXPECT_NEAR(thrust(-1525, 1), thrust(-1525, 0), 1e-9);
}

TEST(KnownLimits, AJointPassesOnTheThrustOfAPodWithoutItsAddedMass) {
  // A neutral pod of 1.025 kg on a fixed joint, with half of its mass as added mass.
  TestWorld test(R"(
shoal: 1
physics: {step_s: 0.01, gravity_mps2: 0}
medium: {water: {density_kgpm3: 1025}}
vehicles:
  - name: v
    position_m: [0, 0, -10]
    model:
      shoal: 1
      vehicle: pod
      bodies:
        - {name: base, parts: [{shape: box, size_m: [0.2, 0.2, 0.2], mass_kg: 10}]}
        - name: pod
          position_m: [0.5, 0, 0]
          parts:
            - {shape: box, size_m: [0.1, 0.1, 0.1], mass_kg: 1.025, added_mass_coefficient: 0.5, drag_coefficient: 0}
      joints:
        - {name: mount, type: fixed, bodies: [base, world]}
        - {name: arm, type: fixed, bodies: [base, pod]}
      devices:
        - {name: push, type: thruster, body: pod, command: thrust_N, curve: direct, max: 100}
        - {name: load, type: joint_load, joint: arm, frame: world}
)");
  test::Listener<shoal::wrench_t> load(test, "v.load");
  test.send("v.push.cmd", shoal::actuator_command_t{0, 10});
  test.run_for(2);
  EXPECT_NEAR(std::abs(load.take_all().back().force_N[0]), 10 / 1.5, 0.01);
}

TEST(KnownLimits, AMovingMassPushesNoVehicleByItsMotion) {
  WetBox box(wet_device("type: moving_mass, mass_kg: 9, rate_mps: 1"));  // without gravity
  box.command(0.03);
  box.run_for(0.1);
  EXPECT_EQ(box.body.v_WB_W(), Vector3d::Zero());
  EXPECT_EQ(box.body.w_WB_W(), Vector3d::Zero());
}

TEST(KnownLimits, WaterInTheHullDoesNotMakeItHeavier) {
  TestWorld test(test::marine_world("type: leak, leaking: true, ingress_lps: 100, volume_l: 50"));
  test.run_for(1);
  EXPECT_EQ(test.world.find_vehicle("r1")->body("hull").mass_kg(), 1);
}

TEST(KnownLimits, AHullByCoefficientsFeelsTheWavesAtItsOrigin) {
  const auto place = [](const char* length_m) {
    TestWorld test(R"(
shoal: 1
physics: {step_s: 0.01}
medium: {water: {}, waves: {type: regular, height_m: 0.4, period_s: 3}}
vehicles:
  - name: v
    position_m: [0, 0, -4]
    model:
      shoal: 1
      vehicle: hull
      bodies:
        - name: hull
          hydrodynamics: {mass_kg: 100, inertia_kgm2: [50, 50, 50], linear_damping: [9, 9, 9, 9, 9, 9]}
          parts: [{shape: box, size_m: [)" +
                   std::string(length_m) + ", 0.3, 0.3]}]\n");
    test.run_for(3);
    return test.world.vehicles()[0]->body("hull").X_WB().translation();
  };
  EXPECT_GT((place("0.3") - Vector3d(0, 0, -4)).norm(), 0.001);
  EXPECT_EQ(place("0.3"), place("20"));  // the waves are 14 m long
}

TEST(KnownLimits, AReceiverThatIsRelocatedHearsWhatHasPassed) {
  const std::string modem = "{name: modem, type: acoustic_modem}";
  TestWorld test(test::modem_sea({{"a", "[0, 0, -20]", modem}, {"b", "[1500, 0, -20]", modem}}));
  test::Listener<shoal::acoustic_received_t> at_b(test, "b.modem");
  test.run_for(0.01);
  test.send("a.modem.cmd", test::bytes_to("x"));
  test.run_for(0.5);  // its front is 750 m away
  test.world.editor().move_vehicle("b", sim::make_pose({150, 0, -20}, Vector3d::Zero()));
  test.run_for(5);
  const auto received = at_b.take_all();
  ASSERT_EQ(received.size(), 1u);
  EXPECT_GT(received[0].travel_time_s, 0.4);  // 0.1 s would be that of the path
}

TEST(KnownLimits, ARangeBeaconAnswersThroughWaterAtOnce) {
  const std::string beacon = "{name: b, type: range_beacon, rate_hz: 100, phase_s: 0, range_max_m: 5000, ";
  TestWorld test(test::modem_sea({{"a", "[0, 0, -20]", beacon + "through: acoustic}"},
                                  {"c", "[1500, 0, -20]", beacon + "through: acoustic, beacon_only: true}"}}));
  test::Listener<shoal::range_beacon_t> at_a(test, "a.b");
  test.run_for(0.01);
  ASSERT_EQ(at_a.last().range_m.size(), 1u);  // sound needs a second
}

TEST(KnownLimits, AGyroscopeDoesNotFeelTheEarthTurn) {
  TestWorld test(test::marine_world("type: imu"));
  test::Listener<shoal::imu_t> truth(test, "r1.s.truth");
  test.run_for(1);
  EXPECT_LT(Vector3d(truth.last().angular_velocity_radps).norm(), 1e-9);  // the Earth turns by 7.3e-5 rad/s
}

TEST(KnownLimits, ACompassHasOneDeclinationForTheWorld) {
  const auto heading = [](const char* position_m) {
    TestWorld test(test::marine_world("type: compass", position_m));
    test::Listener<shoal::compass_t> reports(test, "r1.s");
    test.run_for(1);
    return reports.last().heading_rad;
  };
  EXPECT_EQ(heading("[0, 0, -10]"), heading("[100000, 100000, -10]"));
}

TEST(KnownLimits, AGpsFarFromTheOriginIsAboveTheSea) {
  const auto height_m = [](const char* position_m) {
    TestWorld test(test::marine_world("type: gps", position_m));
    test::Listener<shoal::gps_data_t> truth(test, "r1.s.truth");
    test.run_for(1);
    return truth.last().elev;
  };
  // The tangent plane leaves the ellipsoid by d^2 / (2 N), N = 6388 km at 42 degrees.
  EXPECT_NEAR(height_m("[10000, 0, 1]") - height_m("[0, 0, 1]"), 7.83, 0.02);
}

TEST(KnownLimits, ALidarSeesAsFarInWaterAsInAir) {
  const std::string wall =
      "[{name: wall, fixed: true, position_m: [91, 0, 0], parts: [{shape: box, size_m: [2, 9, 99]}]}]";
  for (const char* position_m : {"[0, 0, -10]", "[0, 0, 10]"}) {
    TestWorld test(test::marine_world("type: lidar, beams: 1, range_max_m: 100", position_m, wall));
    test::Listener<shoal::planar_lidar_t> truth(test, "r1.s.truth");
    test.run_for(0.01);
    EXPECT_NEAR(truth.last().ranges[0], 90, 1e-4) << position_m;
  }
}

}  // namespace
