// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tests/devices/world_fixture.hpp"

namespace range_beacon_fixture {

/// Boxes without weight: r1 at the origin, and others.
inline std::string boxes(const std::string& r1, const std::string& others = "", const std::string& objects = "") {
  return "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\nobjects: [" + objects + "]\nvehicles:\n" +
         "  - {name: r1, position_m: [0, 0, 0], model: {shoal: 1, vehicle: box, bodies: [{name: hull, parts: [{shape: "
         "box, size_m: [0.2, 0.2, 0.2], mass_kg: 1}]}], devices: [{name: b, type: range_beacon, rate_hz: 100, phase_s: "
         "0, truth: true" +
         r1 + "}]}}\n" + others;
}

}  // namespace range_beacon_fixture
