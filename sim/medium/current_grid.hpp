// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/medium/medium_config.hpp"

namespace sim {

/// Current that varies horizontally, constant over depth and time: bilinear interpolation in a regular grid.
class CurrentGrid {
 public:
  /// Reads the files of a current of type grid.  Throws TerrainError with the name of the file.
  explicit CurrentGrid(const CurrentConfig& config);

  bool contains(double x_m, double y_m) const {
    return x_m >= west_m_ && y_m >= south_m_ && x_m <= west_m_ + (columns_ - 1) * cell_x_m_ &&
           y_m <= south_m_ + (rows_ - 1) * cell_y_m_;
  }
  /// Velocity in the world, m/s.
  Vector3d velocity_W(double x_m, double y_m) const;
  /// Whether the velocity outside is that at the border; else it is zero.
  bool keeps_edge() const { return edge_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// Positions of the first and the last point.
  Eigen::Vector2d low_m() const { return {west_m_, south_m_}; }
  Eigen::Vector2d high_m() const { return {west_m_ + (columns_ - 1) * cell_x_m_, south_m_ + (rows_ - 1) * cell_y_m_}; }

 private:
  void read_csv(std::string_view text);
  void read_esri(const std::string& east_path, const std::string& north_path);

  bool edge_;  ///< outside, the velocity at the border; else zero
  int columns_ = 0, rows_ = 0;
  double west_m_ = 0, south_m_ = 0, cell_x_m_ = 1, cell_y_m_ = 1;
  std::vector<Eigen::Vector2d> velocities_mps_;  ///< rows from south to north, each from west to east
};

}  // namespace sim
