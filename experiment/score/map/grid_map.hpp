// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/image/image.hpp"

namespace experiment {

/// Square cells in the plane of the world; column 0 and row 0 have the smallest x and y.
struct MapFrame {
  double origin_x_m = 0;  ///< corner of the first cell, in the world frame
  double origin_y_m = 0;
  double cell_m = 0.05;
  int width = 0;   ///< cells along x
  int height = 0;  ///< cells along y

  std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  }
  bool operator==(const MapFrame&) const = default;
};

/// State of a cell of a map.  In a true map `solid` is the inside of an object, which no range sensor sees.
enum class Cell : std::uint8_t { free = 0, occupied = 1, solid = 2, unknown = 3 };

/// Map of cells, row by row from the origin.
struct GridMap {
  MapFrame frame;
  std::vector<Cell> cells;
};

/// Largest number of cells of a map.
inline constexpr std::int64_t max_map_cells = 64'000'000;

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
