// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/config/param_reader.hpp"
#include "sim/model/hydrodynamics_config.hpp"

namespace test {

/// A world of still water with one vehicle of one body, `hull`, at 20 m depth, heading east.  `hydrodynamics`: keys of
/// the map, in braces.
inline std::string marine_world(const std::string& hydrodynamics, const std::string& medium = "{water: {}}",
                                const std::string& entry = "", const std::string& step_s = "0.001") {
  return "shoal: 1\nphysics: {step_s: " + step_s + "}\nmedium: " + medium +
         "\nvehicles:\n  - name: auv\n    position_m: [0, 0, -20]\n" + entry +
         "    model:\n      shoal: 1\n      vehicle: test\n      bodies:\n        - name: hull\n"
         "          hydrodynamics: " +
         hydrodynamics + "\n          parts: [{shape: sphere, radius_m: 0.1}]\n";
}

/// The map of `hydrodynamics:`, in braces.  Throws ConfigError.
inline sim::HydrodynamicsConfig config_of(const std::string& text) {
  sim::Diagnostics diagnostics;
  const sim::ConfigNode node = sim::parse_config_text(text, "test", diagnostics);
  sim::HydrodynamicsConfig config;
  sim::ParamReader in(node, "", diagnostics);
  config.read(in);
  in.finish();
  diagnostics.throw_if_any();
  return config;
}

}  // namespace test
