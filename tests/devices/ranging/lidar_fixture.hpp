// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace lidar_fixture {

inline std::string lidar(const std::string& more = "") {
  return "        - {name: lidar, type: lidar, position_m: [0, 0, 0.3], beams: 181, range_max_m: 10, rate_hz: 10, "
         "truth: true" +
         more + "}\n";
}

/// Front face at x = 5 m.
inline constexpr const char* wall =
    "  - {name: wall, fixed: true, position_m: [6, 0, 1], parts: [{shape: box, size_m: [2, 100, 2]}]}\n";

}  // namespace lidar_fixture
