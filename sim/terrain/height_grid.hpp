// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/geometry/mesh.hpp"

namespace sim {

/// Terrain that cannot be used; what() says why, without a place.
class TerrainError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The surface at a place: its height and derivatives.
struct SurfacePoint {
  double height_m = 0;
  double slope_x = 0, slope_y = 0;                                                  ///< of the height along x and y
  double bend_xx_pm = 0, bend_xy_pm = 0, bend_yy_pm = 0;                            ///< second derivatives, 1/m
  Vector3d normal() const { return Vector3d(-slope_x, -slope_y, 1).normalized(); }  ///< upwards
};

/// Heights at the points of a regular grid, in the frame T of the terrain: x east, y north, z up.  Between four
/// neighbouring points lies a cell.
///
/// Two surfaces go over the points.  The triangles are what is seen: each cell is split along the diagonal from its
/// south-west to its north-east corner.  The smooth surface is the collision surface: the biquadratic B-spline whose
/// control points are the points of the grid (de Boor, A Practical Guide to Splines, for uniform knots).  It has no
/// edges (C1), never leaves the range of the nine heights around a place, bends no more than the second differences of
/// the heights say, so that a step in them becomes no spike of acceleration, and passes over the middles of the edges
/// of the triangles.  At the points it lies below peaks and above pits by an eighth of the second difference along
/// each axis.  A plane stays the same plane, to its border.
struct HeightGrid {
  static constexpr std::int64_t max_cells = 16'000'000;
  static constexpr std::int64_t max_side = 65'536;  ///< points along x or y
  static constexpr double min_cell_m = 1e-4;
  static constexpr double max_place_m = 1e7;  ///< of a point, along each axis: as far as a part may be

  int columns = 0, rows = 0;  ///< points along x and y, at least 2 each
  double cell_m = 1;
  double west_m = 0, south_m = 0;  ///< of the first point, in T
  std::vector<double> heights_m;   ///< rows from south to north, each from west to east

  double at(int column, int row) const { return heights_m[static_cast<std::size_t>(row) * columns + column]; }
  double& at(int column, int row) { return heights_m[static_cast<std::size_t>(row) * columns + column]; }
  double width_m() const { return (columns - 1) * cell_m; }  ///< along x
  double depth_m() const { return (rows - 1) * cell_m; }     ///< along y
  double lowest_m() const;
  double highest_m() const;
  bool contains(double x, double y) const {
    return x >= west_m && y >= south_m && x <= west_m + width_m() && y <= south_m + depth_m();
  }
  /// Number of the cell that a place lies in, counted as the points are, with columns - 1 cells in a row; places
  /// outside belong to the nearest cell.
  std::size_t cell_at(double x, double y) const;
  std::size_t cells() const { return static_cast<std::size_t>(columns - 1) * static_cast<std::size_t>(rows - 1); }

  /// The smooth surface; places outside are taken to the border.
  SurfacePoint smooth_at(double x, double y) const;
  double height(double x, double y) const { return smooth_at(x, y).height_m; }
  /// Height of the triangles; places outside are taken to the border.
  double facet_height(double x, double y) const;
};

/// Throws TerrainError unless there are 2 x 2 to max_cells points, with room for all in one array.
void check_grid_size(std::int64_t columns, std::int64_t rows);
/// Throws TerrainError for heights that are not finite, or are probably not in metres: a span over 20 km, or
/// more than half of the cells steeper than 89 degrees.
void check_heights(const HeightGrid& grid);
/// The triangles: two a cell, in the order of the cells, the south-eastern one first.
Mesh mesh_of(const HeightGrid& grid);

}  // namespace sim
