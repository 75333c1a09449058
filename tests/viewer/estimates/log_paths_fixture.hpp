// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "shoal/message_codec.hpp"
#include "shoal/waypoints_command_t.hpp"

namespace log_paths_fixture {

inline constexpr double unknown_m = std::numeric_limits<double>::quiet_NaN();

/// A path along y = x from 0 to `end_m`, as many meters deep.
inline shoal::waypoints_command_t path_to(double end_m, double depth_m = unknown_m, int points = 2) {
  shoal::waypoints_command_t path{};
  path.n = points;
  for (int i = 0; i < points; ++i) {
    path.x_m.push_back(end_m * i / (points - 1));
    path.y_m.push_back(path.x_m.back());
    path.depth_m.push_back(depth_m);
  }
  return path;
}

}  // namespace log_paths_fixture
