// SPDX-License-Identifier: BSD-3-Clause
// The Segway RMP of vehicles/: what it weighs, how it falls, and that its wheels do not wobble.

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "shoal/joint_servo_command_t.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/fidelity/closed_forms.hpp"
#include "tests/project_paths.hpp"
#include "tests/scratch_folder.hpp"

namespace {

using sim::Vector3d;
using test::closed_form;
using test::ClosedForm;

constexpr double degrees = 180 / std::numbers::pi;
constexpr double wheel_m = 0.236, platform_over_axle_m = -0.074;

/// A Segway on a plane, leaning forward by an angle about the ground under its axle.
struct Setting {
  double tilt_rad = 0;
  std::string overrides = "";  ///< of its file, such as `, joints.left.low_stop: -1`
  std::string joints = "";     ///< lines of a `joints:` list that it has besides
  std::string physics = "{step_s: 0.005}";
};

struct Segway : test::TestWorld {
  explicit Segway(const Setting& setting) : TestWorld(world_of(setting)) {
    for (const char* motor : {"left_motor", "right_motor"}) {
      shoal::joint_servo_command_t coast{};
      coast.mode = 3;
      send(std::string("s.") + motor + ".cmd", coast);
    }
  }
  static std::string world_of(const Setting& setting) {
    const test_support::ScratchFolder scratch;  // the file is read at once
    std::ofstream(scratch.file("segway.yaml"))
        << "include: " << test_support::source_path("vehicles/segway_rmp.yaml") << "\n"
        << "shoal: 1\nvehicle: segway_in_test\n"
        << (setting.joints.empty() ? "" : "joints:\n" + setting.joints);
    std::ostringstream text;
    text.precision(12);
    text << "shoal: 1\nphysics: " << setting.physics
         << "\nobjects: [{name: ground, fixed: true, parts: [{shape: plane}]}]\n"
         << "vehicles:\n  - name: s\n    file: " << scratch.file("segway.yaml") << "\n    position_m: [0, 0, "
         << wheel_m * (1 - std::cos(setting.tilt_rad)) + 1e-4 << "]\n    rpy_deg: [0, " << setting.tilt_rad * degrees
         << ", 0]\n    overrides: {actuator_latency_s: 0, devices.camera.rate_hz: 0.1" << setting.overrides << "}\n";
    return sim::to_yaml(sim::load_world_text(text.str(), "worlds/test.yaml").resolved);
  }
  const sim::Vehicle& vehicle() { return *world.find_vehicle("s"); }
  const sim::Body& base() { return vehicle().body("base"); }
  double tilt_rad() {
    const Vector3d up_B = base().X_WB().linear().row(2).transpose();
    return std::atan2(-up_B.x(), up_B.z());
  }
};

TEST(Segway, HasTheMassesOfThePaper) {
  Segway test({});
  const Vector3d p_AC = test.base().p_BC() - Vector3d(0, 0, -platform_over_axle_m);  // from the axle
  const double mass_kg = test.base().mass_kg();
  const auto expect = [](double value, const char* quantity) {
    const ClosedForm form = closed_form("segway_ubersim", "axle_z=0.074", quantity);
    EXPECT_NEAR(value, form.expected, form.tolerance) << quantity;
  };
  expect(mass_kg, "body_mass");
  expect(p_AC.z(), "com_height_over_axle");
  expect(test.base().inertia_C_B()(1, 1) + mass_kg * (p_AC.x() * p_AC.x() + p_AC.z() * p_AC.z()),
         "pitch_inertia_about_axle");
  // Leaning back by this angle its center of mass is over the axle.
  expect(std::atan2(p_AC.x(), p_AC.z()) * degrees, "static_balance_lean");
  EXPECT_NEAR(test.base().p_BC().y(), 0, 1e-12);
}

/// Its wheels are fixed to the world; the body turns freely about the axle.
constexpr const char* locked_wheels = R"(
  - {name: left_lock, type: fixed, bodies: [left_wheel, world]}
  - {name: right_lock, type: fixed, bodies: [right_wheel, world]}
)";

double balanced_rad() {
  return -closed_form("segway_ubersim", "", "static_balance_lean").expected / degrees;
}

TEST(Segway, StandsBalancedWhereItsMassIsOverItsAxle) {
  Segway test({.tilt_rad = balanced_rad(), .joints = locked_wheels});
  test.run_for(1);
  // Whatever it is off grows as cosh(3.8 t), by 22; the demand on the tilt is 0.02 degrees.
  EXPECT_NEAR(test.tilt_rad() * degrees, balanced_rad() * degrees, 0.02 * 22);
}

TEST(Segway, FallsAtTheRateOfTheClosedForm) {
  const ClosedForm rate = closed_form("segway_ubersim", "", "fall_rate_wheels_locked");
  constexpr double start_rad = 0.25 / degrees, time_s = 0.8;
  double tilt_rad[2] = {};
  for (const int forward : {0, 1}) {
    Segway test({.tilt_rad = balanced_rad() + (forward == 1 ? start_rad : -start_rad),
                 .joints = locked_wheels,
                 .physics = "{step_s: 0.001}"});
    test.run_for(time_s);
    tilt_rad[forward] = test.tilt_rad();
  }
  // Half the difference of a fall to each side: where exactly it balances does not matter.  It comes to 2.6 degrees,
  // where a sine is 0.03 % less than its angle.
  const double grown = (tilt_rad[1] - tilt_rad[0]) / 2 / start_rad;
  EXPECT_NEAR(std::acosh(grown) / time_s, rate.expected, rate.tolerance);
}

/// How far a wheel is from where its axle should hold it.
struct Wobble {
  double axis_deg = 0;   ///< largest angle between the wheel's axle and the body's
  double center_mm = 0;  ///< largest way of its middle on the body
  double tilt_deg = 0;   ///< largest tilt from the balanced one: it was kept up
};

/// Balanced by the truth, it speeds up, is pushed from the side, and slows down.
Wobble wobble_of(const std::string& overrides, const std::string& solver = "auto", const std::string& joints = "",
                 double step_s = 0.005) {
  Segway test({.tilt_rad = balanced_rad(),
               .overrides = overrides,
               .joints = joints,
               .physics = "{step_s: " + std::to_string(step_s) + ", solver: " + solver + "}"});
  Wobble worst;
  double distance = 0;
  for (int step = 0; step * step_s < 20; ++step) {
    const double t = step * step_s;
    const auto& wheels = {std::pair{"left", 0.285}, std::pair{"right", -0.285}};
    const double rate = (test.base().X_WB().linear().transpose() * test.base().w_WB_W()).y();
    const double speed =
        wheel_m * (test.vehicle().joint("left").velocity(1) + test.vehicle().joint("right").velocity(1) + 2 * rate) / 2;
    const double slow = (t < 1 ? 0 : t < 12 ? 1.5 : 0) - speed;
    distance += std::clamp(slow, -0.5, 0.5) * step_s;
    const double desired = balanced_rad() + std::clamp(0.12 * slow + 0.02 * distance, -0.15, 0.15);
    const double torque = 300 * (test.tilt_rad() - desired) + 60 * rate;
    for (const auto& [name, y] : wheels) test.vehicle().joint(name).add_effort(std::clamp(torque / 2, -50.0, 50.0), 1);
    // 20 N s, as someone who bumps into it.
    if (t >= 8 && t < 8.2)
      test.vehicle().body("base").add_force_W({0, 100, 0}, test.base().X_WB() * test.base().p_BC());
    test.world.step();
    if (t < 0.1) continue;
    const sim::Pose X_BW = test.base().X_WB().inverse();
    for (const auto& [name, y] : wheels) {
      const sim::Body& wheel = test.vehicle().body(std::string(name) + "_wheel");
      const sim::Pose X_BR = X_BW * wheel.X_WB();
      worst.axis_deg = std::max(worst.axis_deg, std::acos(std::clamp(X_BR.linear()(1, 1), -1.0, 1.0)) * degrees);
      worst.center_mm =
          std::max(worst.center_mm, 1e3 * (X_BR.translation() - Vector3d(0, y, -platform_over_axle_m)).norm());
    }
    worst.tilt_deg = std::max(worst.tilt_deg, std::abs(test.tilt_rad() - balanced_rad()) * degrees);
  }
  return worst;
}

/// `, joints.left.KEY: VALUE` and the same on the right.
std::string both(const std::string& key, const std::string& value) {
  return ", joints.left." + key + ": " + value + ", joints.right." + key + ": " + value;
}

/// As the paper has them: 75 mm outside of the wheels' middles.
const std::string anchors_of_the_paper =
    ", joints.left.anchor_m: [0, 0.36, 0.236], joints.right.anchor_m: [0, -0.36, 0.236]";

/// Steering that gives way by a hundredth of a radian, or wholly.
const std::string slack = both("low_stop", "-0.01") + both("high_stop", "0.01");
const std::string free_steering = both("low_stop", "-3.1") + both("high_stop", "3.1");

TEST(Segway, ItsWheelsStayOnTheirAxles) {
  const Wobble wobble = wobble_of("");
  EXPECT_LT(wobble.axis_deg, 1e-3);  // the softness of the constraints, cfm 1e-9, and their errors of second order
  EXPECT_LT(wobble.center_mm, 0.02);
  EXPECT_LT(wobble.tilt_deg, 15);
}

TEST(Segway, WheelsWithAnchorsBesideThemAndSteeringThatGivesWayWobble) {
  const Wobble with_slack = wobble_of(anchors_of_the_paper + slack);
  EXPECT_GT(with_slack.axis_deg, 0.5);  // from stop to stop: 0.01 rad
  const Wobble without_stops = wobble_of(anchors_of_the_paper + free_steering);
  EXPECT_GT(without_stops.axis_deg, 90) << "the drive turns the wheels around";
  EXPECT_GT(without_stops.tilt_deg, 45) << "and it falls";
}

TEST(Segway, WithoutSlackOrWithoutALeverArmItsWheelsStayWithinTheSlack) {
  EXPECT_LT(wobble_of(anchors_of_the_paper).axis_deg, 1e-3) << "no slack";
  const Wobble no_lever_arm = wobble_of(slack);
  RecordProperty("axis_deg", std::to_string(no_lever_arm.axis_deg));
  RecordProperty("center_mm", std::to_string(no_lever_arm.center_mm));
  EXPECT_LT(no_lever_arm.axis_deg, 0.7) << "nothing holds a wheel that stands on its middle, within 0.57 degrees";
  EXPECT_LT(no_lever_arm.tilt_deg, 15);
}

TEST(Segway, ASoftSuspensionSinksAndDoesNotWobble) {
  const Wobble soft = wobble_of(anchors_of_the_paper + both("suspension_erp", "0.2") + both("suspension_cfm", "0.002"));
  EXPECT_LT(soft.axis_deg, 1e-2);
  EXPECT_GT(soft.center_mm, 20);
}

TEST(Segway, TheBallJointsOfThePaperHoldTheWheelsAsWell) {
  const Wobble patched = wobble_of(anchors_of_the_paper + free_steering, "auto", R"(
  - {name: left_ball, type: ball, bodies: [base, left_wheel], anchor_m: [0, 0, 0.236]}
  - {name: right_ball, type: ball, bodies: [base, right_wheel], anchor_m: [0, 0, 0.236]}
)");
  EXPECT_LT(patched.axis_deg, 1e-3);
}

}  // namespace
