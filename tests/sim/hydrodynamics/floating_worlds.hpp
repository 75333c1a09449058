// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/config/message_text.hpp"
#include "tests/devices/world_fixture.hpp"

namespace test {

/// One free object in still water with its surface at 0; `parts`: a YAML list.
inline std::string floating_world(const std::string& parts, const std::string& position_m, double step_s = 0.001,
                                  const std::string& more = "") {
  return "shoal: 1\nphysics: {step_s: " + sim::number_text(step_s) +
         ", gravity_mps2: 9.80665}\nmedium: {water: {density_kgpm3: 1025}}\nobjects:\n  - {name: it, position_m: " +
         position_m + ", parts: " + parts + more + "}\n";
}

inline sim::Body& body_of(LoadedTestWorld& test) {
  return test.world.find_object("it")->base();
}

/// The mean time between upward crossings of `rest` by what `value` gives, while `time_s` pass.
template <typename Value>
double period_of(LoadedTestWorld& test, double time_s, double rest, const Value& value) {
  std::vector<double> crossings;
  double last = value() - rest;
  const double step_s = sim::to_seconds(test.world.step_time());
  for (double t = 0; t < time_s; t += step_s) {
    test.world.step();
    const double now = value() - rest;
    if (last < 0 && now >= 0) crossings.push_back(t + step_s * last / (last - now));
    last = now;
  }
  if (crossings.size() < 3) return 0;
  return (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
}

}  // namespace test
