// SPDX-License-Identifier: BSD-3-Clause
#include "sim/terrain/height_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/config/message_text.hpp"

namespace sim {
namespace {

/// Position of a coordinate among the points of one axis.
struct Seat {
  int index;  ///< index of the nearest point
  double t;   ///< offset from it in cells, -0.5 to 0.5
};

Seat seat(double from_first_m, double cell_m, int points) {
  const double s = std::clamp(from_first_m / cell_m, 0.0, points - 1.0);
  const int index = static_cast<int>(s + 0.5);
  return {index, s - index};
}

/// Heights around a point relative to its own height, extrapolated linearly beyond the border.
struct Neighbors {
  double d[3][3];  // [row][column]

  Neighbors(const HeightGrid& grid, int column, int row) {
    const double middle = grid.at(column, row);
    const bool inside = column > 0 && row > 0 && column + 1 < grid.columns && row + 1 < grid.rows;
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i)
        d[j + 1][i + 1] = (inside ? grid.at(column + i, row + j) : beyond(grid, column + i, row + j)) - middle;
  }
  static double beyond(const HeightGrid& grid, int column, int row) {
    if (row < 0) return 2 * beyond(grid, column, 0) - beyond(grid, column, 1);
    if (row >= grid.rows) return 2 * beyond(grid, column, grid.rows - 1) - beyond(grid, column, grid.rows - 2);
    if (column < 0) return 2 * grid.at(0, row) - grid.at(1, row);
    if (column >= grid.columns) return 2 * grid.at(grid.columns - 1, row) - grid.at(grid.columns - 2, row);
    return grid.at(column, row);
  }
};

/// Uniform quadratic B-spline in one dimension: weights of value and derivatives at t.
struct Weights {
  double value[3], slope[3];
  explicit Weights(double t)
      : value{0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)},
        slope{t - 0.5, -2 * t, t + 0.5} {}
  static constexpr double bend[3] = {1, -2, 1};
};

}  // namespace

double HeightGrid::lowest_m() const {
  return *std::min_element(heights_m.begin(), heights_m.end());
}

double HeightGrid::highest_m() const {
  return *std::max_element(heights_m.begin(), heights_m.end());
}

std::size_t HeightGrid::cell_at(double x, double y) const {
  const auto column = static_cast<std::size_t>(std::clamp((x - west_m) / cell_m, 0.0, columns - 2.0));
  const auto row = static_cast<std::size_t>(std::clamp((y - south_m) / cell_m, 0.0, rows - 2.0));
  return row * static_cast<std::size_t>(columns - 1) + column;
}

SurfacePoint HeightGrid::smooth_at(double x, double y) const {
  // Nearest point, heights around it and B-spline weights.
  const Seat u = seat(x - west_m, cell_m, columns), v = seat(y - south_m, cell_m, rows);
  const Neighbors around(*this, u.index, v.index);
  const Weights a(u.t), b(v.t);
  // Tensor product of the splines along x and y.
  SurfacePoint point;
  point.height_m = at(u.index, v.index);
  for (int j = 0; j < 3; ++j) {
    double value = 0, slope = 0, bend = 0;
    for (int i = 0; i < 3; ++i) {
      value += a.value[i] * around.d[j][i];
      slope += a.slope[i] * around.d[j][i];
      bend += Weights::bend[i] * around.d[j][i];
    }
    point.height_m += b.value[j] * value;
    point.slope_x += b.value[j] * slope;
    point.slope_y += b.slope[j] * value;
    point.bend_xx_pm += b.value[j] * bend;
    point.bend_xy_pm += b.slope[j] * slope;
    point.bend_yy_pm += Weights::bend[j] * value;
  }
  // Convert derivatives from cells to meters.
  const double per_m = 1 / cell_m;
  point.slope_x *= per_m;
  point.slope_y *= per_m;
  point.bend_xx_pm *= per_m * per_m;
  point.bend_xy_pm *= per_m * per_m;
  point.bend_yy_pm *= per_m * per_m;
  return point;
}

double HeightGrid::facet_height(double x, double y) const {
  // Cell and position in the cell.
  const double u = std::clamp((x - west_m) / cell_m, 0.0, columns - 1.0);
  const double v = std::clamp((y - south_m) / cell_m, 0.0, rows - 1.0);
  const int i = std::min(static_cast<int>(u), columns - 2), j = std::min(static_cast<int>(v), rows - 2);
  const double s = u - i, t = v - j;
  // Interpolate in the south-eastern or north-western triangle.
  const double south_west = at(i, j), north_east = at(i + 1, j + 1);
  const double corner = s >= t ? at(i + 1, j) : at(i, j + 1);
  return south_west + std::max(s, t) * (corner - south_west) + std::min(s, t) * (north_east - corner);
}

void check_grid_size(std::int64_t columns, std::int64_t rows) {
  const std::string size = std::to_string(columns) + " x " + std::to_string(rows) + " points";
  if (columns < 2 || rows < 2) throw TerrainError("is not a grid: it has " + size + " and needs at least 2 x 2");
  if (columns > HeightGrid::max_cells || rows > HeightGrid::max_cells || columns * rows > HeightGrid::max_cells)
    throw TerrainError("is too large: it has " + size + ", and may have 16 million");
  // Reject long strips of few rows, which are most likely not height maps.
  if (columns > HeightGrid::max_side || rows > HeightGrid::max_side)
    throw TerrainError("is too long: it has " + size + ", and may have 65536 along a side");
}

namespace {

void check_extent(const HeightGrid& grid) {
  for (const double place_m : {grid.west_m, grid.south_m, grid.west_m + grid.width_m(), grid.south_m + grid.depth_m()})
    if (!(std::abs(place_m) <= HeightGrid::max_place_m))
      throw TerrainError("reaches " + number_text(std::abs(place_m)) +
                         " m from its origin; at most 1e7 m are possible");
  for (const double height_m : {grid.lowest_m(), grid.highest_m()})
    if (std::abs(height_m) > HeightGrid::max_place_m)
      throw TerrainError("has a height of " + number_text(height_m) + " m; at most 1e7 m are possible");
}

}  // namespace

void check_heights(const HeightGrid& grid) {
  for (const double height_m : grid.heights_m)
    if (!std::isfinite(height_m)) throw TerrainError("has a height that is not finite");
  const double span_m = grid.highest_m() - grid.lowest_m();
  if (span_m > 20'000)
    throw TerrainError("spans " + number_text(span_m) + " m of height, more than the earth does: wrong units?");
  // Heights in centimeters over cells in meters are nearly vertical everywhere; a cliff is only here and there.
  const double too_steep = std::tan(degrees_to_radians(89)) * grid.cell_m;
  std::size_t steep = 0;
  for (int j = 0; j + 1 < grid.rows; ++j)
    for (int i = 0; i + 1 < grid.columns; ++i) {
      const auto [low, high] =
          std::minmax({grid.at(i, j), grid.at(i + 1, j), grid.at(i, j + 1), grid.at(i + 1, j + 1)});
      steep += high - low > too_steep;
    }
  if (2 * steep > grid.cells())
    throw TerrainError("is steeper than 89 degrees nearly everywhere: heights and cells in one unit, meters?");
  check_extent(grid);
}

Mesh mesh_of(const HeightGrid& grid) {
  Mesh mesh;
  mesh.vertices_m.reserve(grid.heights_m.size());
  for (int j = 0; j < grid.rows; ++j)
    for (int i = 0; i < grid.columns; ++i)
      mesh.vertices_m.emplace_back(grid.west_m + i * grid.cell_m, grid.south_m + j * grid.cell_m, grid.at(i, j));
  mesh.triangles.reserve(2 * grid.cells());
  const auto columns = static_cast<std::uint32_t>(grid.columns);
  for (std::uint32_t j = 0; j + 1 < static_cast<std::uint32_t>(grid.rows); ++j)
    for (std::uint32_t i = 0; i + 1 < columns; ++i) {
      const std::uint32_t south_west = j * columns + i, north_west = south_west + columns;
      mesh.triangles.push_back({south_west, south_west + 1, north_west + 1});
      mesh.triangles.push_back({south_west, north_west + 1, north_west});
    }
  return mesh;
}

}  // namespace sim
