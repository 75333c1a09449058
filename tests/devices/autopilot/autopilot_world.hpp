// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "shoal/autopilot_command_t.hpp"
#include "shoal/autopilot_state_t.hpp"
#include "shoal/helm_command_t.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world_state.hpp"
#include "tests/devices/world_fixture.hpp"

namespace autopilot_world {

inline constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// One of the shipped vehicles at the origin, 10 m deep unless it floats.  `overrides`: lines of a map.
inline std::string world_with(const std::string& file, const std::string& overrides,
                              const std::string& medium = "{water: {}}", double height_m = -10,
                              const std::string& objects = "") {
  return "shoal: 1\nphysics: {step_s: 0.01}\nmedium: " + medium + "\n" + objects +
         "vehicles:\n  - name: v\n    file: " + file + "\n    position_m: [0, 0, " + std::to_string(height_m) +
         "]\n    overrides:\n" + overrides;
}

class AutopilotWorld : public test::TestWorld {
 public:
  explicit AutopilotWorld(const std::string& yaml) : TestWorld(yaml), states(*this, "v.autopilot") {}
  shoal::autopilot_state_t state_after(double time_s) {
    run_for(time_s);
    return states.last();
  }
  sim::Vector3d place() const { return world.find_vehicle("v")->base().X_WB().translation(); }
  void helm(double speed_mps, double heading_rad, double depth_m, double altitude_m = nothing) {
    send("v.autopilot.cmd", shoal::helm_command_t{0, speed_mps, heading_rad, depth_m, altitude_m});
  }
  void mode(std::int8_t mode) { send("v.autopilot.cmd", shoal::autopilot_command_t{0, mode}); }

  test::Listener<shoal::autopilot_state_t> states;
};

inline double tilt_deg(const AutopilotWorld& test) {
  return std::acos(std::min(1.0, test.world.find_vehicle("v")->base().X_WB().linear()(2, 2))) /
         sim::degrees_to_radians(1);
}

}  // namespace autopilot_world
