// SPDX-License-Identifier: BSD-3-Clause
#include "devices/marine/thruster.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "sim/world/world_editor.hpp"
#include "tests/devices/marine/marine_fixture.hpp"

namespace {

using devices::Thruster;
using test::wet_device;
using test::WetBox;
using testing::HasSubstr;

// Velocities of up to 3 m/s have an error of 1e-16 times that; over 1e-3 s and 10 kg that is 1e-11 N, added up by ODE.
using test::rounding_N;

const char* remus =
    "type: thruster, command: rpm, max: 1525, curve: kt_kq, diameter_m: 0.14, density_kgpm3: 1026, "
    "k_t0: 0.4566, k_t_slope: 0.41737033, k_q0: 0.07, k_q_slope: 0.05850422, wake_fraction: 0.056, "
    "thrust_deduction: 0.1, turns: left, torque_share: 0.1";

/// Thrust in the steady state of a command.
double thrust(WetBox& box, double command) {
  box.set_velocity(sim::Vector3d::Zero());
  box.command(command);
  return box.force_W().x();
}

TEST(Thruster, PullsAtTheBollardAsItsQuadraticCurveSaysAheadAndAstern) {
  // The Otter: 0.01108 and 0.006445 N per (rad/s)^2, limits +103.9309 and -101.7367 rad/s.
  WetBox box(
      wet_device("type: thruster, command: radps, max: 103.9309, min: -101.7367, ahead: 0.01108, "
                 "astern: 0.006445"));
  EXPECT_NEAR(thrust(box, 60), 39.888, rounding_N);
  EXPECT_NEAR(thrust(box, -60), -23.202, rounding_N);
  EXPECT_NEAR(thrust(box, 1000), 0.01108 * 103.9309 * 103.9309, rounding_N);
  EXPECT_NEAR(thrust(box, -1000), -0.006445 * 101.7367 * 101.7367, rounding_N);
}

TEST(Thruster, GivesThrustAndTorqueOfTheRemusAtTheBollardAndUnderWay) {
  const double n = 1525 / 60.0, D = 0.14;
  for (const double speed : {0.0, 2.54}) {
    WetBox box(wet_device(remus));
    box.set_velocity({speed, 0, 0});
    box.command(1525);
    const double Va = 0.944 * speed;
    EXPECT_NEAR(box.force_W().x(), 0.9 * 1026 * std::pow(D, 4) * (0.4566 * n * n - 0.41737033 * Va / D * n),
                rounding_N);
    WetBox turned(wet_device(remus));
    turned.set_velocity({speed, 0, 0});
    turned.command(1525);
    // Positive, as MSS has it: a propeller that turns left.
    EXPECT_NEAR(turned.torque_W().x(), 0.1 * 1026 * std::pow(D, 5) * (0.07 * n * n - 0.05850422 * Va / D * n),
                rounding_N);
  }
}

TEST(Thruster, HasNoThrustAtTheAdvanceRatioOfItsCurveAndBrakesBeyond) {
  const double zero = 0.4566 / 0.41737033 * (1525 / 60.0) * 0.14 / 0.944;
  for (const double share : {0.9, 1.0, 1.1}) {
    WetBox box(wet_device(remus));
    box.set_velocity({share * zero, 0, 0});
    box.command(1525);
    const double bollard = 0.9 * 1026 * std::pow(0.14, 4) * 0.4566 * std::pow(1525 / 60.0, 2);
    EXPECT_NEAR(box.force_W().x(), (1 - share) * bollard, 1e-6);
  }
}

TEST(Thruster, FeelsTheWaterAndNotTheGroundUnlessToldSo) {
  // The water moves along with the vehicle: the thrust is that at the bollard.
  const std::string medium = "{water: {density_kgpm3: 1000, surface_m: 50}, current: {velocity_mps: [2, 0, 0]}}";
  const double bollard = 0.9 * 1026 * std::pow(0.14, 4) * 0.4566 * std::pow(1000 / 60.0, 2);
  const double loss = 0.9 * 1026 * std::pow(0.14, 3) * 0.41737033 * 0.944 * 2 * 1000 / 60.0;
  for (const auto& [inflow, expected] :
       {std::pair{"water", bollard}, {"water_speed", bollard}, {"ground", bollard - loss}}) {
    WetBox box(wet_device(remus + std::string(", inflow: ") + inflow), medium);
    box.set_velocity({2, 0, 0});
    box.command(1000);
    EXPECT_NEAR(box.force_W().x(), expected, rounding_N) << inflow;
  }
}

TEST(Thruster, InflowAtItsOwnPlaceCountsTheTurningOfTheVehicle) {
  // 2 m to the right of the middle of a vehicle that turns left by 0.5 rad/s, the propeller moves ahead at 1 m/s.
  WetBox box(wet_device("type: thruster, position_m: [0, -2, 0], ahead: 100, inflow_loss: 20"));
  box.set_velocity(sim::Vector3d::Zero(), {0, 0, 0.5});
  box.command(0.5);
  EXPECT_NEAR(box.force_W().norm(), 100 * 0.25 - 20 * 0.5 * 1, rounding_N);
}

TEST(Thruster, PushesAlongXOfItsFrameAndTurnsTheHullByItsLever) {
  WetBox box(wet_device("type: thruster, position_m: [-1, 0.5, 0], rpy_deg: [0, 0, 90], ahead: 8"));
  box.command(1);
  EXPECT_NEAR((box.force_W() - sim::Vector3d(0, 8, 0)).norm(), 0, rounding_N);
  WetBox turned(wet_device("type: thruster, position_m: [-1, 0.5, 0], rpy_deg: [0, 0, 90], ahead: 8"));
  turned.command(1);
  EXPECT_NEAR((turned.torque_W() - sim::Vector3d(0, 0, -8)).norm(), 0, rounding_N);
}

TEST(Thruster, APropellerThatTurnsRightTurnsTheHullLeft) {
  for (const auto& [turns, sign] : {std::pair{"right", -1}, {"left", 1}}) {
    WetBox box(wet_device("type: thruster, command: thrust_N, max: 10, torque_per_thrust_m: 0.1407, turns: " +
                          std::string(turns)));
    box.command(3.86);
    EXPECT_NEAR(box.torque_W().x(), sign * 0.1407 * 3.86, rounding_N);
  }
}

TEST(Thruster, FollowsATableOfMeasurements) {
  // A T200 at 16 V by the width of its pulses, as an effort: 1 is 1900 us, 0.25 is 1600 us.
  WetBox box(
      wet_device("type: thruster, curve: table, table: [-1, -39.91, -0.75, -26.58, -0.5, -14.12, -0.25, -4.71, "
                 "-0.07, 0, 0.07, 0, 0.25, 5.88, 0.5, 17.85, 0.75, 33.54, 1, 51.48]"));
  EXPECT_NEAR(thrust(box, 1), 51.48, rounding_N);
  EXPECT_NEAR(thrust(box, -1), -39.91, rounding_N);
  EXPECT_NEAR(thrust(box, 0.375), (5.88 + 17.85) / 2, rounding_N);
  EXPECT_NEAR(thrust(box, 0.05), 0, rounding_N);
}

TEST(Thruster, LagsByTheExactSolutionWhateverTheStep) {
  WetBox box(wet_device("type: thruster, command: thrust_N, max: 100, lag_s: 0.1"));
  box.command(50);
  box.run_for(0.1);
  // Of the last step of 1 ms, half-way.
  EXPECT_NEAR(box.device<Thruster>().thrust_N(), 50 * (1 - std::exp(-0.995)), 1e-12);
  WetBox rest(wet_device("type: thruster, command: thrust_N, max: 100, lag_s: 0.1"));
  rest.command(50);
  rest.run_for(3);
  EXPECT_NEAR(rest.device<Thruster>().thrust_N(), 50, 1e-10);  // exp(-30) of the way is left
}

TEST(Thruster, OfSecondOrderOvershootsAsItsDampingSays) {
  const double w = 20, z = 0.3, damped = w * std::sqrt(1 - z * z);
  WetBox box(
      wet_device("type: thruster, command: thrust_N, max: 100, natural_frequency_radps: 20, damping_ratio: 0.3"));
  box.command(10);
  double max = 0;
  for (int i = 1; i <= 400; ++i) {
    box.world.step();
    const double t = i * 1e-3;
    const double x = 10 * (1 - std::exp(-z * w * t) * (std::cos(damped * t) + z * w / damped * std::sin(damped * t)));
    ASSERT_NEAR(box.device<Thruster>().level(), x, 1e-10) << t;
    max = std::max(max, box.device<Thruster>().level());
  }
  EXPECT_NEAR(max, 10 * (1 + std::exp(-std::numbers::pi * z / std::sqrt(1 - z * z))), 1e-3);
}

TEST(Thruster, OfSecondOrderFollowsTheClosedFormsWithMuchDamping) {
  const double w = 20, t = 0.1;
  for (const double z : {1.0, 2.0}) {
    WetBox box(wet_device("type: thruster, command: thrust_N, max: 100, natural_frequency_radps: 20, damping_ratio: " +
                          std::to_string(z)));
    box.command(10);
    box.run_for(t);
    const double root = std::sqrt(z * z - 1), a = w * (z - root), b = w * (z + root);
    const double x =
        z == 1 ? 1 - std::exp(-w * t) * (1 + w * t) : 1 - (b * std::exp(-a * t) - a * std::exp(-b * t)) / (b - a);
    EXPECT_NEAR(box.device<Thruster>().level(), 10 * x, 1e-10) << z;
  }
}

TEST(Thruster, ChangesItsLevelNoFasterThanItsLimit) {
  WetBox box(wet_device("type: thruster, command: rpm, max: 1000, ahead: 1e-5, rate_limit: 500"));
  box.command(1000);
  box.run_for(0.5);
  EXPECT_NEAR(box.device<Thruster>().level(), 250, 1e-9);
}

TEST(Thruster, IgnoresCommandsInItsDeadBand) {
  WetBox box(wet_device("type: thruster, dead_band: 0.1, ahead: 100"));
  EXPECT_EQ(thrust(box, 0.09), 0);
  EXPECT_EQ(thrust(box, -0.09), 0);
  EXPECT_NEAR(thrust(box, 0.11), 100 * 0.0121, rounding_N);
}

TEST(Thruster, FadesAsItsDiscComesOutOfTheWaterAndDoesNotPushInAir) {
  const auto thrust_at = [](double depth_m, const std::string& more) {
    WetBox box(wet_device("type: thruster, command: thrust_N, max: 10, diameter_m: 0.2" + more),
               "{water: {surface_m: " + std::to_string(depth_m) + "}}");
    return thrust(box, 10);
  };
  EXPECT_NEAR(thrust_at(0.1, ""), 10, rounding_N);
  EXPECT_NEAR(thrust_at(0, ""), 5, rounding_N);
  EXPECT_EQ(thrust_at(-0.1, ""), 0);
  // Smooth at both ends: the slope is 0 there.
  EXPECT_NEAR(thrust_at(0.099, ""), 10, 10 * 3 * 0.005 * 0.005);
  EXPECT_NEAR(thrust_at(0.05, ""), 10 * (3 * 0.75 * 0.75 - 2 * 0.75 * 0.75 * 0.75), rounding_N);
  EXPECT_NEAR(thrust_at(0, ", ventilation: false"), 10, rounding_N);
  WetBox dry(wet_device("type: thruster"), "{}");
  EXPECT_EQ(thrust(dry, 1), 0);
}

TEST(Thruster, TakesThePowerOfItsShaft) {
  WetBox box(wet_device(remus + std::string(", efficiency: 0.5")));
  box.command(1200);
  box.world.step();
  const double Q = 1026 * std::pow(0.14, 5) * 0.07 * 20 * 20;
  EXPECT_NEAR(box.device<Thruster>().power_W(), 2 * std::numbers::pi * 20 * Q / 0.5, 1e-9);
  WetBox half(wet_device("type: thruster, full_power_W: 300"));
  half.command(0.5);
  half.world.step();
  EXPECT_NEAR(half.device<Thruster>().power_W(), 300 * 0.125, 1e-9);  // a quarter of the thrust, to the power of 1.5
}

TEST(Thruster, StopsWhenItsCommandsAreStaleAndWithAShareOfItsEffortPushesLess) {
  WetBox box(wet_device("type: thruster, ahead: 40, watchdog_s: 0.05"));
  box.command(1);
  box.run_for(0.04);
  box.world.editor().set_fault("v/d", {.kind = sim::FaultKind::partial, .effectiveness = 0.25});
  EXPECT_NEAR(box.force_W().x(), 10, 1e-8);
  box.run_for(0.02);
  EXPECT_EQ(box.force_W().x(), 0);
}

TEST(Thruster, ChangesWhileItRuns) {
  WetBox box(wet_device("type: thruster, ahead: 40"));
  EXPECT_NEAR(thrust(box, 1), 40, rounding_N);
  EXPECT_EQ(box.change("v/d", "{max: 0.5}"), "");
  EXPECT_NEAR(box.force_W().x(), 10, rounding_N);
}

TEST(Thruster, IgnoresACommandThatIsNoNumber) {
  WetBox box(wet_device("type: thruster, ahead: 40"));
  EXPECT_NEAR(thrust(box, 1), 40, rounding_N);
  EXPECT_NEAR(thrust(box, std::nan("")), 40, rounding_N);
}

TEST(Thruster, StaysFiniteAtTheEndsOfItsOscillator) {
  for (const char* keys :
       {"natural_frequency_radps: 1e5, damping_ratio: 1e3", "natural_frequency_radps: 0.001",
        "natural_frequency_radps: 1e5, damping_ratio: 1e-9", "natural_frequency_radps: 0.001, damping_ratio: 1e3",
        "natural_frequency_radps: 0.001, damping_ratio: 0.9999999999999999"}) {
    WetBox box(wet_device(std::string("type: thruster, command: thrust_N, max: 100, ") + keys));
    box.send("b.d.cmd", shoal::actuator_command_t{0, 50});
    box.run_for(0.1);
    const double level = box.device<devices::Thruster>().level();
    EXPECT_GE(level, 0) << keys;
    EXPECT_LE(level, 100.1) << keys;
  }
}

TEST(Thruster, SaysWhatIsWrongWithItsParameters) {
  const auto error = [](const std::string& keys) { return test::error_of_device("type: thruster, " + keys); };
  EXPECT_THAT(error("command: rpm"), HasSubstr("'max' is missing: the largest level in the unit of 'command'"));
  EXPECT_THAT(error("max: 2"), HasSubstr("an effort is at most 1"));
  EXPECT_THAT(error("command: thrust_N, max: 5, curve: quadratic"), HasSubstr("'curve' direct belongs to"));
  EXPECT_THAT(error("curve: table"), HasSubstr("'table' must be two or more pairs of level and thrust, got 0 numbers"));
  EXPECT_THAT(error("curve: table, table: [0, 0, -1, 5]"),
              HasSubstr("the levels of 'table' must increase, got 0 before -1"));
  EXPECT_THAT(error("curve: kt_kq"), HasSubstr("'full_speed_rpm' is missing"));
  EXPECT_THAT(error("lag_s: 1, natural_frequency_radps: 5"), HasSubstr("exclude each other"));
  EXPECT_THAT(error("thrust_deduction: 1"), HasSubstr("'thrust_deduction' must be >= 0 and <= 0.99, got 1"));
  EXPECT_THAT(error("wake_fraction: 1"), HasSubstr("'wake_fraction' must be >= 0 and <= 0.99, got 1"));
  EXPECT_THAT(error("natural_frequency_radps: 5, damping_ratio: 1e200"), HasSubstr("'damping_ratio' must be"));
  EXPECT_THAT(error("natural_frequency_radps: 1e200"),
              HasSubstr("'natural_frequency_radps' must be >= 0.001 and <= 100000"));
  EXPECT_THAT(error("natural_frequency_radps: 1e-9"), HasSubstr("must be >= 0.001"));
  EXPECT_THAT(error("lag_s: -1"), HasSubstr("'lag_s' must be >= 0, got -1"));
  EXPECT_THAT(error("turns: up"), HasSubstr("'turns'"));
  EXPECT_EQ(error("max: 1"), "");
}

}  // namespace
