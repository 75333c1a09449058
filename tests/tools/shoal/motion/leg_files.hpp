// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <iterator>
#include <string>

#include "tests/scratch_folder.hpp"

namespace test {

/// A folder with `leg.yaml`, a vehicle with a servo `knee`, also called `maker/knee`, from -1 to 1 rad at up to 2
/// rad/s, a servo `rod` of a slider that parks beyond its stop at 0.1 m, and a lamp.
class LegFiles {
 public:
  LegFiles() {
    write("leg.yaml", R"(shoal: 1
vehicle: leg
bodies:
  - {name: thigh, position_m: [0, 0, 1], parts: [{shape: sphere, radius_m: 0.05, mass_kg: 0.2}]}
  - {name: shin, position_m: [0, 0, 0.8], parts: [{shape: sphere, radius_m: 0.05, mass_kg: 0.1}]}
  - {name: foot, position_m: [0, 0, 0.6], parts: [{shape: sphere, radius_m: 0.05, mass_kg: 0.1}]}
joints:
  - {name: knee, type: hinge, bodies: [shin, thigh], anchor_m: [0, 0, 0.9], axis: [0, 1, 0]}
  - {name: rod, type: slider, bodies: [foot, shin], axis: [0, 0, 1], low_stop: -0.1, high_stop: 0.1}
devices:
  - {name: knee, type: joint_servo, joint: knee, alias: maker/knee, low: -1, high: 1, max_velocity: 2, max_effort: 100}
  - {name: rod, type: joint_servo, joint: rod, park_position: 0.3, max_velocity: 1, max_effort: 100}
  - {name: led, type: led, lights: [{name: lamp}]}
)");
  }

  /// Writes a file, and returns its path.
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  /// Writes a motion of the leg; `keys` in degrees.
  std::string motion(const std::string& name, const std::string& keys) const {
    return write(name + ".yaml", "shoal: 1\nmotion: " + name + "\nvehicle: leg\nkeys: " + keys + "\n");
  }
  std::string path(const std::string& name) const { return folder_.file(name); }
  std::string text_of(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  test_support::ScratchFolder folder_;
};

/// The knee goes to 45 degrees within a second.
inline constexpr const char* bend = "[{at_s: 0, joints: {knee: 0}}, {at_s: 1, joints: {knee: 45}}]";

}  // namespace test
