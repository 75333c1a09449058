// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/servo_gear.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/devices/joint/servo_fixture.hpp"

namespace {

using test::ServoRig;

// A line of 1 N m at standstill and 6 rad/s without load; setpoints and efforts beyond it.
const std::string line = ", stall_effort: 1, no_load_velocity: 6, max_effort: 5, max_velocity: 20";

const std::vector<std::string> controls = {test::velocity_control, test::pid_control};

TEST(JointServo, ReleasedFromItsLoadItDoesNotOvershoot) {
  // Its maximum velocity is the commanded one: it does not catch up with its setpoint.
  ServoRig rig(
      {.keys = ", stall_effort: 1, no_load_velocity: 6, max_velocity: 1", .step_s = 0.002, .inertia_kgm2 = 1e-4});
  rig.load(0.9);
  rig.command(1, 1);
  rig.run_for(0.5);
  EXPECT_NEAR(rig.velocity(), 0.6, 1e-5);
  rig.load(0);
  double largest = 0;
  for (int i = 0; i < 100; ++i) {
    rig.world.step();
    largest = std::max(largest, rig.velocity());
  }
  // The first step gives the sphere 0.9 N m 2 ms / 1e-4 kg m^2 = 18 rad/s at most; the motor limits it to its velocity.
  EXPECT_LE(largest, 1 + 1e-5);
  EXPECT_NEAR(rig.velocity(), 1, 1e-5);
}

TEST(JointServo, IsStableOnAFloatingChainOfLightBodies) {
  // Legs of 0.02 kg on a base of 0.3 kg: inertia no_load / stall is 0.1 ms, far below the step.
  const std::string world = R"(
shoal: 1
physics: {step_s: 0.004, gravity_mps2: 0}
vehicles:
  - name: v1
    model:
      shoal: 1
      vehicle: chain
      bodies:
        - {name: base, parts: [{shape: sphere, radius_m: 0.05, mass_kg: 0.3}]}
        - {name: upper, position_m: [0, 0, -0.1], parts: [{shape: box, size_m: [0.02, 0.02, 0.08], mass_kg: 0.02}]}
        - {name: lower, position_m: [0, 0, -0.18], parts: [{shape: box, size_m: [0.02, 0.02, 0.08], mass_kg: 0.02}]}
      joints:
        - {name: hip, type: hinge, bodies: [base, upper], anchor_m: [0, 0, -0.06], axis: [0, 1, 0]}
        - {name: knee, type: hinge, bodies: [upper, lower], anchor_m: [0, 0, -0.14], axis: [0, 1, 0]}
      devices:
)";
  const std::string keys = ", stall_effort: 1, no_load_velocity: 6, max_velocity: 5}\n";
  test::TestWorld test(world + "        - {name: hip, type: joint_servo, joint: hip" + keys +
                       "        - {name: knee, type: joint_servo, joint: knee" + keys);
  for (int i = 0; i < 20; ++i) {
    for (const char* const name : {"hip", "knee"}) {
      shoal::joint_servo_command_t message{};
      message.position = (i % 2 == 0) == (std::string(name) == "hip") ? 0.5 : -0.5;
      test.send(std::string("v1.") + name + ".cmd", message);
    }
    for (int step = 0; step < 60; ++step) {
      test.world.step();
      for (const char* const name : {"hip", "knee"})
        ASSERT_LE(std::abs(test.world.find_vehicle("v1")->joint(name).velocity()), 6) << name << i << step;
    }
  }
  test.run_for(1);
  EXPECT_NEAR(test.world.find_vehicle("v1")->joint("knee").position(), 0.5, 1e-4);
  EXPECT_NEAR(test.world.find_vehicle("v1")->joint("hip").position(), -0.5, 1e-4);
}

TEST(JointServo, PartlyDeadItsStallEffortIsTheShare) {
  ServoRig rig({.keys = line});
  rig.world.editor().set_fault("v1/servo", {.kind = sim::FaultKind::partial, .effectiveness = 0.5});
  rig.load(0.25);
  rig.command(1, 20);
  rig.run_for(4);
  EXPECT_NEAR(rig.velocity(), 3, 1e-4);  // half of half the stall effort
}

/// A box of 1 kg on a floor, whose friction stops it wherever it is.  A servo moves it along x by a slide of 0.1 kg, in
/// which it is free to move up and down.
class SledRig : public test::TestWorld {
 public:
  explicit SledRig(const std::string& keys, double step_s) : TestWorld(yaml(keys, step_s)) {}
  /// Moves the servo to a position and returns the position of the box.
  double rest_at(double position) {
    shoal::joint_servo_command_t message{};
    message.position = position;
    send("v1.servo.cmd", message);
    run_for(7);
    return world.find_vehicle("v1")->joint("rail").position();
  }

 private:
  static std::string yaml(const std::string& keys, double step_s) {
    std::ostringstream text;
    text << "shoal: 1\nphysics: {step_s: " << step_s << R"(}
materials: [{name: rubber}]
contacts: [{between: [rubber, any], friction: 1}]
objects: [{name: floor, fixed: true, parts: [{shape: plane}]}]
vehicles:
  - name: v1
    position_m: [0, 0, 0.05]
    model:
      shoal: 1
      vehicle: sled
      bodies:
        - {name: slide, position_m: [0, 0, 0.3], parts: [{shape: box, size_m: [0.1, 0.1, 0.1], mass_kg: 0.1}]}
        - {name: box, parts: [{shape: box, size_m: [0.1, 0.1, 0.1], mass_kg: 1, material: rubber}]}
      joints:
        - {name: rail, type: slider, bodies: [slide, world], axis: [1, 0, 0]}
        - {name: guide, type: slider, bodies: [slide, box], axis: [0, 0, 1]}
      devices:
        - {name: servo, type: joint_servo, joint: rail, max_effort: 100, max_velocity: 0.05)"
         << keys << "}\n";
    return text.str();
  }
};

TEST(JointServo, DeadTravelOnReversalIsThePlay) {
  for (const auto& [control, step_s] : std::vector<std::pair<std::string, double>>{
           {"", 0.001}, {"", 0.002}, {"", 0.004}, {", control: pid, kp: 1e5, kd: 100", 0.001}}) {
    SledRig rig(", play: 0.1" + control, step_s);
    const double out = rig.rest_at(0.3), back = rig.rest_at(0), out_again = rig.rest_at(0.3);
    // 1 %: when the servo stops, the sled slides on by v^2 / (2 g) = 0.13 mm; the error of the pid is 10.8 N / kp =
    // 0.11 mm in each direction.
    EXPECT_NEAR(0.3 - (out - back), 0.1, 0.01 * 0.1) << control << step_s;
    EXPECT_NEAR(0.3 - (out_again - back), 0.1, 0.01 * 0.1) << control << step_s;
    EXPECT_NEAR(out, 0.3 - 0.05, 0.01 * 0.1) << control << step_s;  // it starts in the middle of the play
  }
}

TEST(JointServo, TheLoadIsFreeWithinThePlayAndHeldAtItsEnds) {
  ServoRig rig({.keys = ", play: 0.2, max_effort: 50"});
  rig.load(0.5);
  rig.run_for(0.05);
  // At 50 rad/s^2, in 50 steps: semi-implicit Euler.
  EXPECT_NEAR(rig.position(), -50 * 0.05 * 0.051 / 2, 1e-6);
  rig.run_for(0.5);
  EXPECT_NEAR(rig.position(), -0.1, 1e-5);
  EXPECT_NEAR(rig.velocity(), 0, 1e-5);
  rig.load(-0.5);
  rig.run_for(0.5);
  EXPECT_NEAR(rig.position(), 0.1, 1e-5);
}

TEST(JointServo, TheMotorDoesNotPullALoadThatRunsAhead) {
  ServoRig rig({.keys = ", play: 0.2, max_velocity: 2, max_acceleration: 50, max_effort: 50"});
  rig.command(1, 2);
  rig.run_for(0.5);
  EXPECT_NEAR(rig.velocity(), 2, 1e-4);
  rig.command(1, 0);
  rig.world.step();
  rig.run_for(0.045);
  EXPECT_NEAR(rig.velocity(), 2, 1e-4);  // the motor needs 0.04 s to stop, and the load 0.1 s for the play
  rig.run_for(0.5);
  EXPECT_NEAR(rig.velocity(), 0, 1e-4);
}

TEST(JointServo, FrictionHoldsTheLoadWithoutPower) {
  for (const std::string& control : controls) {
    const auto angle = [&](double load_Nm) {
      ServoRig rig({.keys = ", friction: 0.3" + control});
      rig.command(3);
      rig.load(load_Nm);
      rig.run_for(1);
      return rig.position();
    };
    EXPECT_NEAR(angle(0.297), 0, 1e-5) << control;
    // 1 % above the friction: uniform acceleration.
    EXPECT_NEAR(angle(0.303), -0.003 / 0.01 / 2, 0.01 * 0.15) << control;
  }
}

TEST(JointServo, AnEffortMovesTheLoadByWhatExceedsTheFriction) {
  const auto velocity = [&](double effort_Nm) {
    ServoRig rig({.keys = ", friction: 0.3, max_velocity: 100"});
    rig.command(2, effort_Nm);
    rig.run_for(0.5);
    return rig.velocity();
  };
  EXPECT_NEAR(velocity(0.297), 0, 1e-5);
  EXPECT_NEAR(velocity(0.5), 0.2 / 0.01 * 0.5, 1e-3);
  EXPECT_NEAR(velocity(-0.5), -0.2 / 0.01 * 0.5, 1e-3);
}

TEST(JointServo, AVelocityMotorDrivesAgainstFrictionAndHoldsWithIt) {
  for (const double step_s : {0.001, 0.002, 0.004})
    for (const double inertia_kgm2 : {1e-4, 1e-2}) {
      // The motor has 0.5 N m, the friction is 0.3 N m.
      const auto velocity = [&](double desired, double load_Nm) {
        ServoRig rig({.keys = ", friction: 0.3, max_effort: 0.5", .step_s = step_s, .inertia_kgm2 = inertia_kgm2});
        rig.load(load_Nm);
        rig.command(1, desired);
        rig.run_for(3);
        return rig.velocity();
      };
      EXPECT_NEAR(velocity(1, 0.19), 1, 1e-4) << step_s;  // from 1 rad/s^2 on
      EXPECT_NEAR(velocity(1, 0.202), 0, 1e-4) << step_s;
      EXPECT_NEAR(velocity(1, 0.79), 0, 1e-3) << step_s;
      EXPECT_NEAR(velocity(0, 0.79), 0, 1e-4) << step_s;
      EXPECT_LT(velocity(0, 0.81), -1) << step_s;
      EXPECT_NEAR(velocity(-1, 0.5), -1, 1e-4) << step_s;  // it lowers the load
    }
}

TEST(JointServo, AMotorWeakerThanTheFrictionMovesNothing) {
  for (const char* const play : {"", ", play: 0.1"}) {
    ServoRig rig({.keys = ", friction: 0.3, max_effort: 0.29" + std::string(play)});
    rig.command(1, 1);
    rig.run_for(1);
    EXPECT_NEAR(rig.position(), 0, 1e-4) << play;
  }
}

TEST(JointServo, DrawsThePowerOfItsMotorNotOfTheFriction) {
  ServoRig rig({.keys = ", friction: 0.3, max_effort: 2, efficiency: 0.5, holding_W: 8",
                .devices = "        - {name: battery, type: battery}\n"});
  rig.load(0.5);
  rig.command(1, 1);
  rig.run_for(0.5);
  // The motor gives 0.8 N m at 1 rad/s.
  const auto* device = rig.world.find_vehicle("v1")->find_device("servo")->actuator();
  EXPECT_NEAR(device->power_W(), 0.8 / 0.5 + 8 * 0.4 * 0.4, 1e-3);
}

TEST(JointServo, SaysWhatIsWrongWithItsGear) {
  const auto error_of = [](const std::string& keys) { return test::error_of_world(ServoRig::yaml({.keys = keys})); };
  EXPECT_THAT(error_of(", stall_effort: 1"),
              testing::HasSubstr("device 'servo': 'stall_effort' needs 'no_load_velocity'"));
  EXPECT_THAT(error_of(", no_load_velocity: 1"),
              testing::HasSubstr("device 'servo': 'no_load_velocity' needs 'stall_effort'"));
  EXPECT_THAT(error_of(", play: -1"), testing::HasSubstr("'play' must be >= 0, got -1"));
}

}  // namespace
