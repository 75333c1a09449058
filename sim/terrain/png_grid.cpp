// SPDX-License-Identifier: BSD-3-Clause
#include <stdexcept>

#include "sim/base/whole_file.hpp"
#include "sim/image/image_file.hpp"
#include "sim/terrain/terrain.hpp"

namespace sim {
namespace {

constexpr std::uintmax_t max_file_mb = 256;

Image16 read_levels(const std::string& path) {
  const std::string bytes = whole_file<TerrainError>(path, max_file_mb);
  try {
    return decode_png_levels(std::as_bytes(std::span(bytes)), [](std::uint64_t width, std::uint64_t height) {
      check_grid_size(static_cast<std::int64_t>(width), static_cast<std::int64_t>(height));
    });
  } catch (const ImageError& error) {
    throw TerrainError(std::string("cannot be read as heights: ") + error.what());
  }
}

}  // namespace

HeightGrid read_png_grid(const std::string& path, double cell_m, double low_m, double high_m) {
  const Image16 levels = read_levels(path);
  HeightGrid grid;
  grid.columns = levels.width;
  grid.rows = levels.height;
  grid.cell_m = cell_m;
  grid.heights_m.resize(levels.data.size());
  std::size_t next = 0;
  // Images begin in the north, grids in the south.
  for (int row = grid.rows - 1; row >= 0; --row)
    for (int column = 0; column < grid.columns; ++column)
      grid.at(column, row) = low_m + (high_m - low_m) * levels.data[next++] / 65535.0;
  return grid;
}

}  // namespace sim
