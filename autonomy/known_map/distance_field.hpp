// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "autonomy/filters/pose2.hpp"
#include "shoal/occupancy_grid_t.hpp"

namespace autonomy {

/// Square cells in the plane of the world, row by row from the corner with the smallest x and y.
struct GridFrame {
  Vector2d origin_W = Vector2d::Zero();
  double cell_m = 0.05;
  int columns = 0, rows = 0;

  bool contains(int column, int row) const { return column >= 0 && row >= 0 && column < columns && row < rows; }
  int column_of(double x_m) const { return static_cast<int>(std::floor((x_m - origin_W.x()) / cell_m)); }
  int row_of(double y_m) const { return static_cast<int>(std::floor((y_m - origin_W.y()) / cell_m)); }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
  Vector2d center_W(int column, int row) const { return origin_W + cell_m * Vector2d(column + 0.5, row + 0.5); }
  bool operator==(const GridFrame& other) const {
    return origin_W == other.origin_W && cell_m == other.cell_m && columns == other.columns && rows == other.rows;
  }
  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

/// A cell is occupied from this probability on, percent, and free up to the other one, as map_server has it.
inline constexpr int occupied_percent = 65, free_percent = 20;

/// Throws shoal::MessageError unless 0.001 m <= cell_m <= 1 m, the origin is within 1e7 m, and there are 1 to 16
/// million cells.
GridFrame frame_of(const shoal::occupancy_grid_t& map);

/// Returns for each cell the distance of its center to that of the nearest marked one, m; infinity without any (exact
/// Euclidean distance transform, Felzenszwalb and Huttenlocher 2012).
std::vector<float> distances_m(const GridFrame& frame, const std::vector<char>& marked);

}  // namespace autonomy
