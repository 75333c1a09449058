// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "autonomy/filters/pose2.hpp"
#include "shoal/occupancy_grid_t.hpp"

namespace test {

using autonomy::Vector2d;

/// A free map with boxes in it; without any, `low` to `high` is free.
inline shoal::occupancy_grid_t flat_map(const Vector2d& low, const Vector2d& high, double cell_m) {
  shoal::occupancy_grid_t map{};
  map.cell_m = cell_m;
  map.origin_m[0] = low.x();
  map.origin_m[1] = low.y();
  map.width = static_cast<std::int32_t>(std::lround((high.x() - low.x()) / cell_m));
  map.height = static_cast<std::int32_t>(std::lround((high.y() - low.y()) / cell_m));
  map.ncells = map.width * map.height;
  map.cells.assign(static_cast<std::size_t>(map.ncells), 0);
  return map;
}

/// Sets the cells whose centers are in a box.
inline void set_box(shoal::occupancy_grid_t& map, const Vector2d& low, const Vector2d& high, int percent = 100) {
  for (int row = 0; row < map.height; ++row)
    for (int column = 0; column < map.width; ++column) {
      const double x_m = map.origin_m[0] + (column + 0.5) * map.cell_m,
                   y_m = map.origin_m[1] + (row + 0.5) * map.cell_m;
      if (x_m > low.x() && x_m < high.x() && y_m > low.y() && y_m < high.y())
        map.cells[static_cast<std::size_t>(row * map.width + column)] = static_cast<std::int8_t>(percent);
    }
}

}  // namespace test
