// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "shoal/joint_command_t.hpp"
#include "shoal/joint_servo_command_t.hpp"
#include "shoal/wrench_t.hpp"
#include "tests/devices/world_fixture.hpp"

// Driven joints at their stops.

namespace {

/// A bar of 1 kg that swings about one end on a base that is fixed to the world.
struct Swivel {
  std::string stops = "low_stop: 0, high_stop: 1.5";
  double step_s = 0.01;
  std::string servo = "type: joint_servo, max_velocity: 1, max_effort: 50";
  std::string axis = "[0, 0, 1]";  // without weight; [0, 1, 0]: the weight pulls it to positive angles
  double mass_kg = 1, length_m = 0.3;
};
/// About its end: of a box of 0.3 by 0.05 by 0.05 m.
constexpr double own_inertia_kgm2 = (0.3 * 0.3 + 0.05 * 0.05) / 12 + 0.15 * 0.15;

class SwivelRig : public test::TestWorld {
 public:
  explicit SwivelRig(const Swivel& swivel) : TestWorld(yaml(swivel)) {}

  enum Mode { position_mode, velocity_mode, effort_mode, coast_mode };
  void command(Mode mode, double value = 0) {
    shoal::joint_servo_command_t message{};
    message.mode = static_cast<std::int8_t>(mode);
    message.position = message.velocity = message.effort = value;
    send("r.servo.cmd", message);
  }
  void run_motor_at(double velocity) {
    shoal::joint_command_t message{};
    message.velocity = velocity;
    send("r.servo.cmd", message);
  }
  void push(double torque_Nm) {
    shoal::wrench_t message{};
    message.torque_Nm[2] = torque_Nm;
    send("r.push.cmd", message);
  }
  const sim::Joint& joint() const { return world.find_vehicle("r")->joint("swivel"); }
  /// Runs and notes the largest speed, and the largest and the smallest position.
  void watch(double time_s) {
    fastest = 0;
    highest = lowest = joint().position();
    for (const sim::Time end = world.now() + sim::from_seconds(time_s); world.now() < end;) {
      world.step();
      fastest = std::max(fastest, std::abs(joint().velocity()));
      highest = std::max(highest, joint().position());
      lowest = std::min(lowest, joint().position());
    }
  }
  double fastest = 0, highest = 0, lowest = 0;

 private:
  static std::string yaml(const Swivel& swivel) {
    std::ostringstream text;
    text << "shoal: 1\nphysics: {step_s: " << swivel.step_s << R"(}
vehicles:
  - name: r
    position_m: [0, 0, 1]
    model:
      shoal: 1
      vehicle: v
      bodies:
        - {name: base, parts: [{shape: box, size_m: [0.2, 0.2, 0.2], mass_kg: 10}]}
        - name: arm
          position_m: [0, 0, 0.3]
          parts: [{shape: box, size_m: [)"
         << swivel.length_m << ", " << swivel.length_m / 6 << ", " << swivel.length_m / 6 << "], position_m: ["
         << swivel.length_m / 2 << ", 0, 0], mass_kg: " << swivel.mass_kg << R"(}]
      joints:
        - {name: mount, type: fixed, bodies: [base, world]}
        - {name: swivel, type: hinge, bodies: [base, arm], anchor_m: [0, 0, 0.3], axis: )"
         << swivel.axis << (swivel.stops.empty() ? "" : ", ") << swivel.stops << R"(}
      devices:
        - {name: push, type: body_wrench, body: arm}
        - {name: servo, joint: swivel, )"
         << swivel.servo << "}\n";
    return text.str();
  }
};

constexpr double steps_s[] = {0.01, 0.005, 0.002};

/// Stops with one at the start, in the direction of `sign` from it.
std::string stops_from_zero(double sign) {
  return sign > 0 ? "low_stop: 0, high_stop: 1.5" : "low_stop: -1.5, high_stop: 0";
}

// The motor's softness (cfm 1e-9) is far below 1e-6 rad/s.
TEST(JointAtItsStop, AServoLeavesItAtItsVelocityInAnyModeAndStep) {
  for (const double step_s : steps_s)
    for (const double sign : {1.0, -1.0}) {
      SCOPED_TRACE(testing::Message() << step_s << " s, " << sign);
      SwivelRig by_position({.stops = stops_from_zero(sign), .step_s = step_s});
      by_position.watch(0.5);
      EXPECT_NEAR(by_position.fastest, 0, 1e-6) << "it holds where it starts";
      by_position.command(SwivelRig::position_mode, 0.3 * sign);
      by_position.watch(1);
      EXPECT_NEAR(by_position.fastest, 1, 1e-6);
      EXPECT_NEAR(by_position.joint().position(), 0.3 * sign, 1e-6);
      SwivelRig by_velocity({.stops = stops_from_zero(sign), .step_s = step_s});
      by_velocity.watch(0.5);
      by_velocity.command(SwivelRig::velocity_mode, 0.5 * sign);
      by_velocity.watch(1);
      EXPECT_NEAR(by_velocity.fastest, 0.5, 1e-6);
      EXPECT_NEAR(by_velocity.joint().position(), 0.5 * sign, 0.5 * step_s + 1e-6);
    }
}

TEST(JointAtItsStop, AnEffortMovesAServoAwayAsFromAnywhereElse) {
  for (const double step_s : steps_s) {
    double fastest[2];
    for (const bool has_stops : {false, true}) {
      SwivelRig rig({.stops = has_stops ? stops_from_zero(1) : "", .step_s = step_s});
      rig.watch(0.5);
      EXPECT_NEAR(rig.fastest, 0, 1e-6);
      rig.command(SwivelRig::effort_mode, 1);
      rig.watch(1);
      fastest[has_stops ? 1 : 0] = rig.fastest;
    }
    // 1 N m gives dw = step / I in a step, and acts until the velocity is at least 1 rad/s.  1e-4: in each step the bar
    // leaves its circle along the tangent, and is pulled back.
    const double in_a_step = step_s / own_inertia_kgm2;
    EXPECT_NEAR(fastest[1], std::ceil(1 / in_a_step) * in_a_step, 1e-4) << step_s;
    EXPECT_NEAR(fastest[1], fastest[0], 1e-6) << step_s;
  }
}

TEST(JointAtItsStop, ALimpArmIsLiftedFromItAtTheCommandedVelocity) {
  for (const double step_s : steps_s) {
    SwivelRig rig({.stops = stops_from_zero(-1), .step_s = step_s, .axis = "[0, 1, 0]"});
    rig.command(SwivelRig::coast_mode);
    rig.watch(0.5);
    EXPECT_NEAR(rig.joint().position(), 0, 1e-6);
    rig.command(SwivelRig::velocity_mode, -0.5);
    rig.watch(1);
    EXPECT_NEAR(rig.fastest, 0.5, 1e-5) << step_s;  // the hinge is a little softer than its motor
    EXPECT_NEAR(rig.joint().position(), -0.5, 0.5 * step_s + 1e-4) << step_s;
  }
}

TEST(JointAtItsStop, AServoTooWeakForTheWeightLeavesTheArmOnIt) {
  // The weight has a moment of 1.47 N m, the servo 1 N m.
  SwivelRig rig({.stops = stops_from_zero(-1),
                 .servo = "type: joint_servo, max_velocity: 1, max_effort: 1",
                 .axis = "[0, 1, 0]"});
  rig.command(SwivelRig::velocity_mode, -0.5);
  rig.watch(2);
  EXPECT_NEAR(rig.highest, 0, 1e-6);
  EXPECT_NEAR(rig.lowest, 0, 1e-6);
}

TEST(JointAtItsStop, AMotorThatPushedIntoItLeavesItAtItsVelocity) {
  for (const double step_s : steps_s) {
    SwivelRig rig({.stops = "low_stop: -1, high_stop: 1",
                   .step_s = step_s,
                   .servo = "type: joint_motor, max_velocity: 5, max_force: 50"});
    rig.run_motor_at(2);
    rig.watch(1);
    EXPECT_NEAR(rig.joint().position(), 1, 1e-3);
    rig.run_motor_at(-0.5);
    rig.watch(0.5);
    EXPECT_NEAR(rig.fastest, 0.5, 1e-6) << step_s;
    EXPECT_NEAR(rig.joint().position(), 0.75, 1e-3 + 0.5 * step_s) << step_s;
  }
}

TEST(JointAtItsStop, ALightFingerDoesNotSpin) {
  for (const double step_s : steps_s) {
    SwivelRig rig({.step_s = step_s,
                   .servo = "type: joint_servo, max_velocity: 1, max_effort: 2",
                   .mass_kg = 0.02,
                   .length_m = 0.05});
    rig.watch(0.5);
    rig.command(SwivelRig::position_mode, 0.3);
    rig.watch(2);
    EXPECT_LE(rig.fastest, 1.05) << step_s;
    EXPECT_NEAR(rig.joint().position(), 0.3, 1e-6) << step_s;
  }
}

TEST(JointAtItsStop, APidServoLeavesItWithItsEffort) {
  SwivelRig rig({.servo = "type: joint_servo, max_velocity: 1, max_effort: 50, control: pid, kp: 50, kd: 2"});
  rig.command(SwivelRig::position_mode, 0.3);
  rig.watch(2);
  EXPECT_LE(rig.fastest, 1.3);  // the overshoot of this control, as from anywhere else
  EXPECT_NEAR(rig.joint().position(), 0.3, 1e-3);
}

/// Stops near half a turn, where ODE's angle wraps.
std::string stops_at(double stop) {
  std::ostringstream text;
  text << "low_stop: " << -stop << ", high_stop: " << stop;
  return text.str();
}

TEST(JointAtItsStop, AStopNearHalfATurnHoldsAgainstAnEffort) {
  for (const double stop : {3.14159, 3.14, 3.1, 3.05, 2.5})
    for (const double effort_Nm : {40.0, 5.0, -5.0, -40.0})
      for (const double step_s : {0.01, 0.002}) {
        SCOPED_TRACE(testing::Message() << stop << " rad, " << effort_Nm << " N m, " << step_s << " s");
        SwivelRig rig({.stops = stops_at(stop),
                       .step_s = step_s,
                       .servo = "type: joint_servo, max_velocity: 10, max_effort: 50"});
        rig.watch(0.5);
        rig.command(SwivelRig::effort_mode, effort_Nm);
        rig.watch(5.5);
        // A stop acts from the step after the one in which the joint reaches it.
        EXPECT_LE(std::max(rig.highest, -rig.lowest), stop + rig.fastest * step_s);
        EXPECT_LE(rig.fastest, 10 + std::abs(effort_Nm) * step_s / own_inertia_kgm2);
        EXPECT_NEAR(rig.joint().position(), std::copysign(stop, effort_Nm), 1e-3);
      }
}

TEST(JointAtItsStop, AStopNearHalfATurnHoldsAgainstAMotor) {
  for (const double step_s : {0.01, 0.002})
    for (const double sign : {1.0, -1.0}) {
      SwivelRig rig(
          {.stops = stops_at(3.14), .step_s = step_s, .servo = "type: joint_motor, max_velocity: 10, max_force: 50"});
      rig.run_motor_at(5 * sign);
      rig.watch(6);
      EXPECT_LE(std::max(rig.highest, -rig.lowest), 3.19);
      rig.run_motor_at(-2 * sign);
      rig.watch(1);
      EXPECT_NEAR(rig.fastest, 2, 1e-6);
      EXPECT_NEAR(rig.joint().position(), sign * 1.14, 2 * step_s + 1e-3);
    }
}

TEST(JointAtItsStop, ADoorThatIsPushedStaysBetweenItsStops) {
  for (const double step_s : {0.01, 0.002})
    for (const bool down : {false, true}) {
      SwivelRig rig({.stops = down ? "low_stop: -3.1, high_stop: 0" : stops_at(3.14),
                     .step_s = step_s,
                     .servo = "type: joint_servo, max_effort: 1, safe: coast"});
      rig.command(SwivelRig::coast_mode);
      rig.push(down ? -0.01 : 5);
      rig.watch(6);
      const double reached = down ? -rig.lowest : rig.highest;
      EXPECT_LE(reached, (down ? 3.1 : 3.14) + rig.fastest * step_s);
      if (down) {
        EXPECT_GE(rig.lowest, -3.15);
      }
      EXPECT_NEAR(rig.joint().position(), down ? -3.1 : 3.14, 1e-3);
    }
}

TEST(JointAtItsStop, StopsMayBeTurnsApart) {
  SwivelRig rig({.stops = stops_at(10), .servo = "type: joint_servo, max_velocity: 5, max_effort: 50"});
  for (const double sign : {1.0, -1.0, 1.0}) {
    rig.command(SwivelRig::velocity_mode, 5 * sign);
    rig.watch(sign == 1.0 ? 6 : 8);
    EXPECT_NEAR(rig.joint().position(), 10 * sign, 1e-3);
    EXPECT_LE(std::max(rig.highest, -rig.lowest), 10 + 5 * 0.01);
    EXPECT_LE(rig.fastest, 5 + 1e-6);
  }
}

}  // namespace
