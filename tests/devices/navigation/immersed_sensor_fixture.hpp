// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/devices/ranging/ranging_fixture.hpp"

namespace test {

/// A box without weight at `position_m` that carries one device called `s` 100 times a second, in water with its
/// surface at 0 unless `medium` says otherwise.  `vehicles`: more entries of the list, indented by two spaces.
inline std::string marine_world(const std::string& device, const std::string& position_m = "[0, 0, -10]",
                                const std::string& objects = "[]", const std::string& vehicles = "",
                                const std::string& medium = "{water: {surface_m: 0}}",
                                const std::string& rpy_deg = "[0, 0, 0]") {
  return "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\nmedium: " + medium + "\nobjects: " + objects +
         "\nvehicles:\n"
         "  - name: r1\n"
         "    position_m: " +
         position_m + "\n    rpy_deg: " + rpy_deg +
         "\n    model:\n"
         "      shoal: 1\n"
         "      vehicle: box\n"
         "      bodies: [{name: hull, hydrodynamics: {model: none}, parts: [{shape: box, size_m: [0.1, 0.1, 0.1], "
         "mass_kg: 1}]}]\n"
         "      devices: [{name: s, truth: true, rate_hz: 100, phase_s: 0, " +
         device + "}]\n" + vehicles;
}

/// The same world with the box held in place, in gravity, without which there are no waves.
inline std::string held_in_place(std::string yaml) {
  const auto replace = [&](const std::string& what, const std::string& by) {
    yaml.replace(yaml.find(what), what.size(), by);
  };
  replace("gravity_mps2: 0", "gravity_mps2: 9.80665");
  replace("name: hull, ", "name: hull, kinematic: true, ");
  return yaml;
}

/// A bottom through (0, 0, z_m), turned by the pitch about y: its normal tilts towards +x.
inline std::string bottom_at(double z_m, double pitch_deg = 0) {
  const double pitch_rad = sim::degrees_to_radians(pitch_deg);
  return "[{name: bottom, fixed: true, position_m: [" + std::to_string(-std::sin(pitch_rad)) + ", 0, " +
         std::to_string(z_m - std::cos(pitch_rad)) + "], rpy_deg: [0, " + std::to_string(pitch_deg) +
         ", 0], parts: [{shape: box, size_m: [2000, 2000, 2]}]}]";
}

/// Sends the box on its way; without weight and water it keeps its velocity.
inline void set_velocity(LoadedTestWorld& test, const sim::Vector3d& v_W) {
  for (const auto& [name, body] : test.world.find_vehicle("r1")->bodies())
    body->set_velocity_W(v_W, sim::Vector3d::Zero());
}

}  // namespace test
