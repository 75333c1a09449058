// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "shoal/occupancy_grid_t.hpp"

namespace autonomy {

/// Reads a map as `shoal map` writes it: a YAML file of ROS map_server (https://wiki.ros.org/map_server, mode
/// `trinary`, not turned) and the grey PNG beside it that it names.  Cells are 100 (occupied), 0 (free) or -1
/// (unknown); `utime` is 0.  `path` is relative to the working folder; otherwise to the shipped worlds.
/// Throws std::invalid_argument with file, rule and value.
shoal::occupancy_grid_t read_map_file(const std::string& path);

}  // namespace autonomy
