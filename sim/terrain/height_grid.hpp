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

/// Error of a terrain that cannot be used.  what() gives the reason without the file.
class TerrainError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Height and derivatives of a surface at one point.
struct SurfacePoint {
  double height_m = 0;
  double slope_x = 0, slope_y = 0;                                                  ///< dh/dx, dh/dy
  double bend_xx_pm = 0, bend_xy_pm = 0, bend_yy_pm = 0;                            ///< second derivatives, 1/m
  Vector3d normal() const { return Vector3d(-slope_x, -slope_y, 1).normalized(); }  ///< unit vector, upwards
};

/// Heights at the points of a regular grid, in the frame T of the terrain: x east, y north, z up.  Four neighboring
/// points enclose a cell.
///
/// Two surfaces are defined on the points.  Sensors see triangles: each cell is split along the diagonal from its
/// south-west to its north-east corner.  Collisions use a smooth surface by default: the biquadratic B-spline whose
/// control points are the points of the grid (de Boor, A Practical Guide to Splines, for uniform knots).  The spline is
/// C1-continuous.  Its height stays within the range of the nine heights around a point and its curvature within their
/// second differences, so that a step in the heights causes no spike of acceleration.  Where heights vary along one
/// axis only it passes through the midpoints between neighboring points.  At the points of the grid it lies below
/// peaks and above pits by an eighth of the second difference along each axis.  It reproduces a plane exactly, up to
/// the border.
struct HeightGrid {
  static constexpr std::int64_t max_cells = 16'000'000;
  static constexpr std::int64_t max_side = 65'536;  ///< points along x or y
  static constexpr double min_cell_m = 1e-4;
  static constexpr double max_place_m = 1e7;  ///< largest coordinate of a point, same as for parts

  int columns = 0, rows = 0;  ///< points along x and y, at least 2 each
  double cell_m = 1;
  double west_m = 0, south_m = 0;  ///< position of the first point, in T
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
  /// Returns the index of the cell at (x, y), counted in the order of the points with columns - 1 cells per row.
  /// Positions outside the grid belong to the nearest cell.
  std::size_t cell_at(double x, double y) const;
  std::size_t cells() const { return static_cast<std::size_t>(columns - 1) * static_cast<std::size_t>(rows - 1); }

  /// Returns the smooth surface at (x, y).  Positions outside the grid are clamped to its border.
  SurfacePoint smooth_at(double x, double y) const;
  double height(double x, double y) const { return smooth_at(x, y).height_m; }
  /// Returns the height of the triangles at (x, y).  Positions outside the grid are clamped to its border.
  double facet_height(double x, double y) const;
};

/// Throws TerrainError unless the grid has at least 2 x 2 and at most max_cells points.
void check_grid_size(std::int64_t columns, std::int64_t rows);
/// Throws TerrainError for heights that are not finite or are probably not in meters: a range over 20 km, or more than
/// half of the cells steeper than 89 degrees.
void check_heights(const HeightGrid& grid);
/// Returns the triangles: two per cell, in the order of the cells, the south-eastern triangle first.
Mesh mesh_of(const HeightGrid& grid);

}  // namespace sim
