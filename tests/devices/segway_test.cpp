// The Segway RMP of vehicles/: what it weighs, how it falls, and that its wheels do not wobble.

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "shoal/joint_servo_command_t.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/fidelity/closed_forms.hpp"

namespace {

using sim::Vector3d;
using test::closed_form;
using test::ClosedForm;

constexpr double degrees = 180 / std::numbers::pi;
constexpr double radius_m = 0.236, platform_over_axle_m = -0.074;

/// A Segway on a plane, leaning forward by an angle about the ground under its axle.  `overrides`: of its file;
/// `model_keys`: lines of a vehicle file over it, indented by six spaces.
std::string segway_world(double lean_rad, const std::string& overrides = "", const std::string& model_keys = "",
                         double step_s = 0.005) {
  std::string text = "shoal: 1\nphysics: {step_s: " + std::to_string(step_s) + "}\nobjects:\n" +
                     "  - {name: ground, fixed: true, parts: [{shape: plane}]}\nvehicles:\n  - name: s\n";
  text += "    position_m: [0, 0, " + std::to_string(radius_m * (1 - std::cos(lean_rad)) + 1e-4) + "]\n";
  char rpy[80];
  std::snprintf(rpy, sizeof rpy, "    rpy_deg: [0, %.12f, 0]\n", lean_rad * degrees);
  text += rpy;
  text += "    overrides: {actuator_latency_s: 0, devices.camera.rate_hz: 0.1" + overrides + "}\n";
  text += "    model:\n      shoal: 1\n      vehicle: segway_in_test\n      include: " SHOAL_SOURCE_DIR
          "/vehicles/segway_rmp.yaml\n" +
          model_keys;
  return text;
}

struct Segway : test::TestWorld {
  explicit Segway(const std::string& yaml) : TestWorld(yaml) {
    for (const char* motor : {"left_motor", "right_motor"}) {
      shoal::joint_servo_command_t coast{};
      coast.mode = 3;
      send(std::string("s.") + motor + ".cmd", coast);
    }
  }
  sim::Vehicle& vehicle() { return *world.find_vehicle("s"); }
  const sim::Body& base() { return vehicle().body("base"); }
  double lean_rad() {
    const Vector3d up_B = base().X_WB().linear().row(2).transpose();
    return std::atan2(-up_B.x(), up_B.z());
  }
};

TEST(Segway, HasTheMassesOfThePaper) {
  Segway test(segway_world(0));
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
  // Leaning back by this angle its centre of mass is over the axle.
  expect(std::atan2(p_AC.x(), p_AC.z()) * degrees, "static_balance_lean");
  EXPECT_NEAR(test.base().p_BC().y(), 0, 1e-12);
}

/// Its wheels are fixed to the world; the body turns freely about the axle.
constexpr const char* locked_wheels = R"(      joints:
        - {name: left_lock, type: fixed, bodies: [left_wheel, world]}
        - {name: right_lock, type: fixed, bodies: [right_wheel, world]}
)";

double balanced_rad() {
  return -closed_form("segway_ubersim", "", "static_balance_lean").expected / degrees;
}

TEST(Segway, StandsBalancedWhereItsMassIsOverItsAxle) {
  Segway test(segway_world(balanced_rad(), "", locked_wheels));
  test.run_for(1);
  // Whatever it is off grows as cosh(3.8 t), by 22; the demand on the lean is 0.02 degrees.
  EXPECT_NEAR(test.lean_rad() * degrees, balanced_rad() * degrees, 0.02 * 22);
}

TEST(Segway, FallsAtTheRateOfTheClosedForm) {
  const ClosedForm rate = closed_form("segway_ubersim", "", "fall_rate_wheels_locked");
  constexpr double start_rad = 0.25 / degrees, time_s = 0.8;
  double lean_rad[2] = {};
  for (const int forward : {0, 1}) {
    Segway test(segway_world(balanced_rad() + (forward == 1 ? start_rad : -start_rad), "", locked_wheels, 0.001));
    test.run_for(time_s);
    lean_rad[forward] = test.lean_rad();
  }
  // Half the difference of a fall to each side: where exactly it balances does not matter.  It comes to 2.6 degrees,
  // where a sine is 0.03 % less than its angle.
  const double grown = (lean_rad[1] - lean_rad[0]) / 2 / start_rad;
  EXPECT_NEAR(std::acosh(grown) / time_s, rate.expected, rate.tolerance);
}

/// How far a wheel is from where its axle should hold it.
struct Wobble {
  double axis_deg = 0;   ///< largest angle between the wheel's axle and the body's
  double centre_mm = 0;  ///< largest way of its middle on the body
  double lean_deg = 0;   ///< largest lean from the balanced one: it was kept up
  double side_mm = 0;    ///< of the path, from straight on
};

/// Balanced by the truth, it speeds up, drives over a step of the torque and slows down.
Wobble drive(const std::string& overrides, double step_s = 0.005) {
  Segway test(segway_world(balanced_rad(), overrides, "", step_s));
  Wobble worst;
  double way = 0;
  for (int step = 0; step * step_s < 20; ++step) {
    const double t = step * step_s;
    const auto& wheels = {std::pair{"left", 0.285}, std::pair{"right", -0.285}};
    const double rate = (test.base().X_WB().linear().transpose() * test.base().w_WB_W()).y();
    const double speed =
        radius_m * (test.vehicle().joint("left").velocity(1) + test.vehicle().joint("right").velocity(1) + 2 * rate) /
        2;
    const double slow = (t < 1 ? 0 : t < 12 ? 1.5 : 0) - speed;
    way += std::clamp(slow, -0.5, 0.5) * step_s;
    const double wanted = balanced_rad() + std::clamp(0.12 * slow + 0.02 * way, -0.15, 0.15);
    const double torque = 300 * (test.lean_rad() - wanted) + 60 * rate;
    for (const auto& [name, y] : wheels) test.vehicle().joint(name).add_effort(std::clamp(torque / 2, -50.0, 50.0), 1);
    test.world.step();
    if (t < 0.1) continue;
    const sim::Pose X_BW = test.base().X_WB().inverse();
    for (const auto& [name, y] : wheels) {
      const sim::Body& wheel = test.vehicle().body(std::string(name) + "_wheel");
      const sim::Pose X_BR = X_BW * wheel.X_WB();
      worst.axis_deg = std::max(worst.axis_deg, std::acos(std::clamp(X_BR.linear()(1, 1), -1.0, 1.0)) * degrees);
      worst.centre_mm =
          std::max(worst.centre_mm, 1e3 * (X_BR.translation() - Vector3d(0, y, -platform_over_axle_m)).norm());
    }
    worst.lean_deg = std::max(worst.lean_deg, std::abs(test.lean_rad() - balanced_rad()) * degrees);
    worst.side_mm = std::max(worst.side_mm, 1e3 * std::abs(test.base().X_WB().translation().y()));
  }
  std::printf("axis %.4f deg, centre %.3f mm, lean %.2f deg, side %.1f mm, x %.2f  | %s\n", worst.axis_deg,
              worst.centre_mm, worst.lean_deg, worst.side_mm, test.base().X_WB().translation().x(), overrides.c_str());
  return worst;
}

TEST(Segway, Explore) {
  const std::string out = ", joints.left.anchor_m: [0, 0.36, 0.236], joints.right.anchor_m: [0, -0.36, 0.236]";
  const std::string free_ =
      ", joints.left.low_stop: -3.1, joints.left.high_stop: 3.1, joints.right.low_stop: -3.1, joints.right.high_stop: "
      "3.1";
  const auto both = [](const std::string& key, const std::string& value) {
    return ", joints.left." + key + ": " + value + ", joints.right." + key + ": " + value;
  };
  const std::string soft = both("suspension_erp", "0.4") + both("suspension_cfm", "0.8");
  const std::string soft_small = both("suspension_erp", "0.2") + both("suspension_cfm", "0.0001");
  const std::string slack = both("low_stop", "-0.01") + both("high_stop", "0.01");
  const std::string softstop = both("stop_cfm", "0.001");
  for (const std::string& each :
       {std::string(), free_, out, out + free_, out + soft, out + free_ + soft, soft, soft_small, out + soft_small,
        out + soft_small + free_, slack, out + slack, softstop, out + softstop, out + both("stop_erp", "0.8"),
        std::string(", physics.solver: quick")}) {
    try {
      drive(each);
    } catch (const std::exception& e) {
      std::printf("%s | %s\n", e.what(), each.c_str());
    }
  }
}

}  // namespace
