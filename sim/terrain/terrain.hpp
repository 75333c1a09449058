// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/terrain/height_grid.hpp"
#include "sim/terrain/terrain_config.hpp"

namespace sim {

/// Terrain as loaded: heights, and the area of each cell.
struct Terrain {
  HeightGrid grid;
  std::vector<std::uint8_t> area_of_cell;  ///< number of the area, from 1; 0: none.  Empty when there are no areas.

  /// Returns the number of the area at (x, y), from 1; 0: none.
  int area_at(double x, double y) const { return area_of_cell.empty() ? 0 : area_of_cell[grid.cell_at(x, y)]; }
};

/// Reads or generates the terrain.  Throws TerrainError with the name of the file.
Terrain load_terrain(const TerrainConfig& config);

/// Parses an ESRI ASCII grid.  Keywords are accepted in any case and order; rows of heights run from north to south.
/// The position of the south-west point is taken from the file: xllcenter and yllcenter, or xllcorner and yllcorner,
/// which lie half a cell to the south-west of it.  NODATA_value, NaN in all spellings of GDAL and `null` are holes; dx
/// and dy, if equal, are the cellsize.  `quantity`: name of a value in errors.  Throws TerrainError with the line
/// number.
HeightGrid parse_ascii_grid(std::string_view text, double vertical_scale, Holes holes,
                            const std::string& quantity = "height");
/// Reads a PNG with 8 or 16 bits of grey, northernmost row first.  Black is `low_m`, white `high_m`.  Throws
/// TerrainError.
HeightGrid read_png_grid(const std::string& path, double cell_m, double low_m, double high_m);
/// Generates a slope, sine or fractal terrain, centered on the origin.
HeightGrid generate_grid(const TerrainConfig& config);

}  // namespace sim
