// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/terrain/height_grid.hpp"
#include "sim/terrain/terrain_config.hpp"

namespace sim {

/// Ground as loaded: heights, and which area each cell belongs to.
struct Terrain {
  HeightGrid grid;
  std::vector<std::uint8_t> area_of_cell;  ///< 0: none; else the number of the area, from 1.  Empty: no areas.

  /// 0: none.
  int area_at(double x, double y) const { return area_of_cell.empty() ? 0 : area_of_cell[grid.cell_at(x, y)]; }
};

/// Reads or makes the terrain.  Throws TerrainError, which names the file.
Terrain load_terrain(const TerrainConfig& config);

/// An ESRI ASCII grid.  Keywords in any case and order; heights by rows from north to south.  Its south-west point is
/// where the file says: xllcorner is the outer corner of a square around the point, half a cell to the south-west.
/// Throws TerrainError with the line.
HeightGrid parse_ascii_grid(std::string_view text, double vertical_scale, Holes holes);
/// A PNG of 8 or 16 bits of grey, the northern row first; black is `low_m`, white `high_m`.  Throws TerrainError.
HeightGrid read_png_grid(const std::string& path, double cell_m, double low_m, double high_m);
/// slope, sine or fractal, with its south-west point at (-size / 2).
HeightGrid generate_grid(const TerrainConfig& config);

}  // namespace sim
