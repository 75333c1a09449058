// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace support_fixture {

/// A table of 2 kg on four feet at (+-0.3, +-0.2) m; the mass is `offset_m` ahead of the middle, 0.5 m above ground.
inline std::string table_world(double offset_m, const std::string& more = "") {
  std::string parts;
  for (const char* place : {"[0.3, 0.2, 0.05]", "[0.3, -0.2, 0.05]", "[-0.3, 0.2, 0.05]", "[-0.3, -0.2, 0.05]"})
    parts += std::string("            - {shape: sphere, radius_m: 0.05, mass_kg: 1.0e-6, position_m: ") + place + "}\n";
  return R"(shoal: 1
physics: {step_s: 0.001}
objects:
  - {name: ground, fixed: true, parts: [{shape: plane}]}
vehicles:
  - name: t
    model:
      shoal: 1
      vehicle: table
      bodies:
        - name: top
          parts:
            - {shape: sphere, radius_m: 0.05, mass_kg: 2, position_m: [)" +
         std::to_string(offset_m) + ", 0, 0.5]}\n" + parts + more;
}

}  // namespace support_fixture
