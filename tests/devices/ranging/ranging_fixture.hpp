// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/devices/world_fixture.hpp"

namespace test {

/// A box without weight at the origin that carries one device called `s`, 100 times a second.  `objects`: lines of the
/// list of objects, indented by two spaces.
inline std::string ranging_world(const std::string& device, const std::string& objects,
                                 const std::string& materials = "") {
  return "shoal: 1\nphysics: {step_s: 0.01, gravity_mps2: 0}\nmaterials: [{name: nothing_special}" + materials +
         "]\nobjects:\n" + objects +
         "vehicles:\n"
         "  - name: r1\n"
         "    model:\n"
         "      shoal: 1\n"
         "      vehicle: box\n"
         "      bodies: [{name: hull, parts: [{shape: box, size_m: [0.1, 0.1, 0.1], mass_kg: 1}]}]\n"
         "      devices: [{name: s, truth: true, rate_hz: 100, phase_s: 0, " +
         device + "}]\n";
}

/// A wall across x, its front face at `x_m`.
inline std::string wall_at(double x_m, const std::string& material = "nothing_special") {
  return "  - {name: wall, fixed: true, position_m: [" + std::to_string(x_m + 1) +
         ", 0, 0], parts: [{shape: box, size_m: [2, 400, 400], material: " + material + "}]}\n";
}

/// What the device reports first; and the truth of it.
template <typename Message>
Message first_report(const std::string& yaml, const std::string& channel = "r1.s") {
  TestWorld test(yaml);
  Listener<Message> reports(test, channel);
  test.run_for(0.01);
  return reports.last();
}
template <typename Message>
Message first_truth(const std::string& yaml) {
  return first_report<Message>(yaml, "r1.s.truth");
}

struct MeanAndSpread {
  double mean, std, count;
};
template <typename Values>
MeanAndSpread statistics(const Values& values) {
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  const auto count = static_cast<double>(values.size());
  for (const double value : values) squares += (value - sum / count) * (value - sum / count);
  return {sum / count, std::sqrt(squares / count), count};
}

}  // namespace test
