// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "experiment/score/map/grid_map.hpp"
#include "sim/image/image.hpp"

namespace experiment {

/// Returns the image of a map as ROS map_server reads and saves it: north up, 0 occupied, 254 free, 205 unknown.  The
/// inside of objects is unknown.
sim::Image8 map_image(const GridMap& map);
/// Returns the YAML file of map_server for an image beside it: `image`, `mode`, `resolution` in m, `origin` (x and y of
/// the lower left corner in m, yaw), `negate`, `occupied_thresh`, `free_thresh`.
std::string map_yaml(const GridMap& map, const std::string& image);
/// Writes `path`, a .png, and beside it the .yaml of the same name.  Returns the path of the latter.  Throws
/// std::runtime_error with the path when a file cannot be written.
std::string write_map(const std::string& path, const GridMap& map);

}  // namespace experiment
