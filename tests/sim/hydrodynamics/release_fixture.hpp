// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tests/sim/hydrodynamics/floating_worlds.hpp"

namespace release_fixture {

inline const char* sphere_02 = "shape: sphere, radius_m: 0.2, mass_kg: 0.1";
inline const char* bubble = "shape: sphere, radius_m: 0.3, mass_kg: 0.01";
inline const char* no_added_mass = ", added_mass_coefficient: 0";
inline const std::vector<double> steps_s{0.001, 0.005, 0.01, 0.02, 0.05};

inline std::string released(const std::string& part, double step_s, const std::string& more = "") {
  return test::floating_world("[{" + part + "}]", "[0, 0, -2]", step_s, more);
}

}  // namespace release_fixture
