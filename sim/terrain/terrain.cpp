// SPDX-License-Identifier: BSD-3-Clause
#include "sim/terrain/terrain.hpp"

#include <filesystem>

#include "sim/base/whole_file.hpp"
#include "sim/geometry/zone.hpp"

namespace sim {
namespace {

HeightGrid read_grid(const TerrainConfig& config) {
  const std::string path = (std::filesystem::path(config.directory) / config.file).string();
  try {
    switch (config.source) {
      case TerrainConfig::Source::ascii:
        return parse_ascii_grid(whole_file<TerrainError>(path), config.vertical_scale, config.holes);
      case TerrainConfig::Source::png:
        return read_png_grid(path, config.cell_m, config.height_min_m, config.height_max_m);
      case TerrainConfig::Source::slope:
      case TerrainConfig::Source::sine:
      case TerrainConfig::Source::fractal:
        break;
    }
  } catch (const TerrainError& error) {
    throw TerrainError("file '" + path + "' " + error.what());
  }
  return generate_grid(config);
}

/// Moves the grid to the configured origin.
void place(HeightGrid& grid, const TerrainConfig& config) {
  switch (config.origin) {
    case TerrainConfig::Origin::center:
      grid.west_m = -grid.width_m() / 2;
      grid.south_m = -grid.depth_m() / 2;
      return;
    case TerrainConfig::Origin::corner:
      grid.west_m = grid.south_m = 0;
      return;
    case TerrainConfig::Origin::map:
      grid.west_m -= config.map_origin_m[0];
      grid.south_m -= config.map_origin_m[1];
  }
}

ZoneShape zone_shape_of(TerrainAreaConfig::Shape shape) {
  switch (shape) {
    case TerrainAreaConfig::Shape::box:
      return ZoneShape::box;
    case TerrainAreaConfig::Shape::circle:
      return ZoneShape::cylinder;
    case TerrainAreaConfig::Shape::polygon:
      break;
  }
  return ZoneShape::polygon;
}

Zone zone_of(const TerrainAreaConfig& area) {
  constexpr double any_height_m = 1e9;
  ZoneConfig zone;
  zone.shape = zone_shape_of(area.shape);
  zone.position_m = area.center_m;
  zone.rpy_rad.z() = area.yaw_rad;
  zone.size_m = {area.size_m.x(), area.size_m.y(), any_height_m};
  zone.radius_m = area.radius_m;
  zone.height_m = any_height_m;
  zone.points_m = area.points_m;
  return Zone(zone);
}

/// Returns the area of each cell: the last area that contains the center of the cell.
std::vector<std::uint8_t> areas_of_cells(const HeightGrid& grid, const std::vector<TerrainAreaConfig>& areas) {
  if (areas.empty()) return {};
  std::vector<Zone> zones;
  for (const TerrainAreaConfig& area : areas) zones.push_back(zone_of(area));
  std::vector<std::uint8_t> numbers(grid.cells(), 0);
  std::size_t cell = 0;
  for (int j = 0; j + 1 < grid.rows; ++j)
    for (int i = 0; i + 1 < grid.columns; ++i, ++cell) {
      const Vector3d middle(grid.west_m + (i + 0.5) * grid.cell_m, grid.south_m + (j + 0.5) * grid.cell_m, 0);
      for (std::size_t k = zones.size(); k > 0 && numbers[cell] == 0; --k)
        if (zones[k - 1].contains(middle)) numbers[cell] = static_cast<std::uint8_t>(k);
    }
  return numbers;
}

}  // namespace

Terrain load_terrain(const TerrainConfig& config) {
  Terrain terrain{read_grid(config), {}};
  for (double& height_m : terrain.grid.heights_m) height_m += config.vertical_offset_m;
  place(terrain.grid, config);
  check_heights(terrain.grid);
  terrain.area_of_cell = areas_of_cells(terrain.grid, config.areas);
  return terrain;
}

}  // namespace sim
