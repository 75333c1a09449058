// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sstream>
#include <string>

#include "shoal/joint_servo_command_t.hpp"
#include "shoal/wrench_t.hpp"
#include "tests/devices/world_fixture.hpp"

namespace test {

/// A sphere that turns about z without gravity, driven by a servo and loaded with a torque by a body_wrench.
class ServoRig : public TestWorld {
 public:
  struct Setup {
    std::string keys = "";  ///< more keys of the servo, after a comma
    double step_s = 0.001;
    double inertia_kgm2 = 0.01;
    std::string devices = "";  ///< more devices
  };
  explicit ServoRig(const Setup& setup) : TestWorld(yaml(setup)) {}

  /// Commands the servo: mode 0 position, 1 velocity, 2 effort, 3 coast, 4 reset.
  void command(int mode, double value = 0) {
    shoal::joint_servo_command_t message{};
    message.mode = static_cast<std::int8_t>(mode);
    message.position = message.velocity = message.effort = value;
    send("v1.servo.cmd", message);
  }
  /// Applies a load against positive motion.
  void load(double torque_Nm) {
    shoal::wrench_t wrench{};
    wrench.torque_Nm[2] = -torque_Nm;
    send("v1.load.cmd", wrench);
  }
  double position() const { return world.find_vehicle("v1")->joint("hinge").position(); }
  double velocity() const { return world.find_vehicle("v1")->joint("hinge").velocity(); }

  static std::string yaml(const Setup& setup) {
    const double radius_m = 0.05;
    std::ostringstream text;
    text << "shoal: 1\nphysics: {step_s: " << setup.step_s << R"(, gravity_mps2: 0}
vehicles:
  - name: v1
    model:
      shoal: 1
      vehicle: rig
      bodies: [{name: wheel, parts: [{shape: sphere, radius_m: 0.05, mass_kg: )"
         << setup.inertia_kgm2 / (0.4 * radius_m * radius_m) << R"(}]}]
      joints: [{name: hinge, type: hinge, bodies: [wheel, world], axis: [0, 0, 1]}]
      devices:
        - {name: load, type: body_wrench}
        - {name: servo, type: joint_servo, joint: hinge)"
         << setup.keys << "}\n"
         << setup.devices;
    return text.str();
  }
};

/// Keys of each control, stable at steps up to 4 ms for an inertia of 0.01 kg m^2.
inline const std::string velocity_control = "", pid_control = ", control: pid, kp: 100, kd: 1";

}  // namespace test
