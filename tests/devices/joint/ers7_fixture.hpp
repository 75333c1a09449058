// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "devices/joint/joint_servo.hpp"
#include "shoal/joint_servo_command_t.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "tests/devices/joint/ers7_table.hpp"
#include "tests/devices/world_fixture.hpp"
#include "tests/project_paths.hpp"

namespace test::ers7 {

struct Dog : test::TestWorld {
  /// In free space; `step_s` so short that nothing moves.
  explicit Dog(const std::string& file = "ers7", const std::string& overrides = "devices.camera.rate_hz: 0.1")
      : TestWorld("shoal: 1\nphysics: {step_s: 1e-6, gravity_mps2: 0}\nvehicles:\n  - {name: dog, file: " +
                  test_support::source_path("vehicles/") + file + ".yaml, overrides: {" + overrides + "}}\n") {}
  const sim::Vehicle& vehicle() const { return *world.find_vehicle("dog"); }
  const sim::VehicleConfig& config() const { return vehicle().config(); }
};

/// A shipped world with the dog.
struct DogIn : test::LoadedTestWorld {
  explicit DogIn(const std::string& name) : LoadedTestWorld(test_support::source_path("worlds/") + name + ".yaml") {}
  const sim::Vehicle& vehicle() const { return *world.find_vehicle("dog"); }
  void command(const std::string& servo, double angle_deg) {
    shoal::joint_servo_command_t message{};
    message.position = angle_deg / degrees;
    send("dog." + servo + ".cmd", message);
  }
  double tilt_deg() const { return std::acos(std::min(1.0, vehicle().X_WV().linear()(2, 2))) * degrees; }
  double pitch_deg() const { return std::asin(-vehicle().X_WV().linear()(2, 0)) * degrees; }  // nose down
};

/// The entry of this name.
template <typename Entry>
const Entry& named(const std::vector<Entry>& entries, const std::string& name) {
  for (const Entry& entry : entries)
    if (entry.name == name) return entry;
  throw std::out_of_range(name);
}

inline const sim::BodyConfig& body_of(const sim::VehicleConfig& config, const std::string& name) {
  return named(config.bodies, name);
}

inline const sim::PartConfig& part_of(const sim::VehicleConfig& config, const std::string& body,
                                      const std::string& part) {
  return named(body_of(config, body).parts, part);
}

inline const sim::JointConfig& joint_of(const sim::VehicleConfig& config, const std::string& name) {
  return named(config.joints, name);
}

inline const devices::JointServo::Params& servo_params(const sim::VehicleConfig& config, const std::string& name) {
  using Params = sim::detail::ParamsOf<devices::JointServo::Params>;
  return static_cast<const Params&>(*named(config.devices, name).params).params;
}

inline const sim::JointAxisConfig& axis_of(const sim::VehicleConfig& config, const std::string& servo) {
  const auto& params = servo_params(config, servo);
  const sim::JointConfig& joint = joint_of(config, params.joint);
  return params.axis == 0 ? joint.axis1 : joint.axis2;
}

}  // namespace test::ers7
