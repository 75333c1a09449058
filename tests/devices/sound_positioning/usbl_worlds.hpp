// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tests/devices/navigation/immersed_sensor_fixture.hpp"

namespace usbl_worlds {

inline std::string transponder(const std::string& name, const std::string& position_m, const std::string& more = "") {
  return "  - {name: " + name + ", position_m: " + position_m +
         ", model: {shoal: 1, vehicle: box, bodies: [{name: hull, hydrodynamics: {model: none}, parts: [{shape: box, "
         "size_m: [0.2, 0.2, 0.2], mass_kg: 1}]}], devices: [{name: t, type: transponder, rate_hz: 10" +
         more + "}]}}\n";
}

inline std::string usbl_world(const std::string& keys, const std::string& others, const std::string& objects = "[]",
                              const std::string& medium = "{water: {surface_m: 0}}") {
  return test::marine_world("type: usbl" + keys, "[0, 0, -10]", objects, others, medium);
}

}  // namespace usbl_worlds
