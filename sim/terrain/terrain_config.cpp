// SPDX-License-Identifier: BSD-3-Clause
#include "sim/terrain/terrain_config.hpp"

#include <filesystem>

#include "sim/config/choice_keys.hpp"
#include "sim/config/common_keys.hpp"
#include "sim/config/message_text.hpp"
#include "sim/terrain/height_grid.hpp"

namespace sim {
namespace {

/// Reads a list of exactly two numbers.
void read_pair(ParamReader& in, const char* key, std::vector<double>& value, const Rule& rule, const char* meaning) {
  const std::vector<double> before = value;
  in.read(key, value, rule, meaning);
  if (value.size() == 2) return;
  in.error(key, "'" + std::string(key) + "' must be 2 numbers, got " + std::to_string(value.size()));
  value = before;
}

void read_pair(ParamReader& in, const char* key, Vector3d& value, const Rule& rule, const char* meaning) {
  std::vector<double> pair{value.x(), value.y()};
  read_pair(in, key, pair, rule, meaning);
  value = {pair[0], pair[1], 0};
}

constexpr ChoiceWords<TerrainAreaConfig::Shape> area_shape_words{{"box", TerrainAreaConfig::Shape::box},
                                                                 {"circle", TerrainAreaConfig::Shape::circle},
                                                                 {"polygon", TerrainAreaConfig::Shape::polygon}};

ChoiceKeys keys_of_area(TerrainAreaConfig::Shape shape) {
  switch (shape) {
    case TerrainAreaConfig::Shape::box:
      return {"center_m", "size_m", "yaw_deg"};
    case TerrainAreaConfig::Shape::circle:
      return {"center_m", "radius_m"};
    case TerrainAreaConfig::Shape::polygon:
      break;
  }
  return {"points_m"};
}

}  // namespace

void TerrainAreaConfig::read(ParamReader& in) {
  in.read_choice("shape", shape, area_shape_words, "outline, seen from above");
  in.require("material");
  in.read_reference("material", material, "material", "material of the ground inside");
  read_pair(in, "center_m", center_m, any_number(), "box, circle: middle, in the frame of the terrain");
  read_pair(in, "size_m", size_m, above(0), "box: lengths along x and y");
  in.read_deg("yaw_deg", yaw_rad, any_number(), "box: turned counter-clockwise");
  in.read("radius_m", radius_m, above(0), "circle");
  read_points(in, "points_m", points_m, 2, "polygon: three or more corners, in order");
  if (in.describing()) return;
  refuse_keys_of_others(in, "shape", area_shape_words, shape, keys_of_area);
  if (shape == Shape::polygon && points_m.size() < 3)
    in.error("points_m", "'points_m' must have at least 3 corners, got " + std::to_string(points_m.size()));
}

namespace {

constexpr ChoiceWords<TerrainConfig::Source> source_words{{"ascii", TerrainConfig::Source::ascii},
                                                          {"png", TerrainConfig::Source::png},
                                                          {"slope", TerrainConfig::Source::slope},
                                                          {"sine", TerrainConfig::Source::sine},
                                                          {"fractal", TerrainConfig::Source::fractal}};

ChoiceKeys keys_of_source(TerrainConfig::Source source) {
  switch (source) {
    case TerrainConfig::Source::ascii:
      return {"file", "vertical_offset_m", "vertical_scale", "holes", "map_origin_m"};
    case TerrainConfig::Source::png:
      return {"file", "vertical_offset_m", "cell_m", "height_min_m", "height_max_m"};
    case TerrainConfig::Source::slope:
      return {"cell_m", "size_m", "angle_deg", "direction_deg"};
    case TerrainConfig::Source::sine:
      return {"cell_m", "size_m", "direction_deg", "amplitude_m", "wavelength_m"};
    case TerrainConfig::Source::fractal:
      break;
  }
  return {"cell_m", "size_m", "amplitude_m", "wavelength_m", "roughness", "seed"};
}

/// Returns the minimum number of cells per wavelength.
double least_cells_of_wave(TerrainConfig::Source source) {
  switch (source) {
    case TerrainConfig::Source::sine:
      return 2;
    case TerrainConfig::Source::fractal:
      return 4;
    case TerrainConfig::Source::ascii:
    case TerrainConfig::Source::png:
    case TerrainConfig::Source::slope:
      break;
  }
  return 0;
}

/// Reports wavelengths that the grid is too coarse for, because sampling would alias them.
void check_wavelength(ParamReader& in, const TerrainConfig& config) {
  const double cells = least_cells_of_wave(config.source);
  if (config.wavelength_m >= cells * config.cell_m) return;
  in.error(in.has("wavelength_m") ? "wavelength_m" : "cell_m",
           "'wavelength_m' of a " + std::string(word_of(source_words, config.source)) + " must be at least " +
               number_text(cells) + " times 'cell_m', got " + number_text(config.wavelength_m) + " and " +
               number_text(config.cell_m));
}

}  // namespace

void TerrainConfig::read(ParamReader& in) {
  if (!in.describing()) {
    place = in.node()->place;
    if (place.file) directory = std::filesystem::path(*place.file).parent_path().string();
  }
  // Kind of source and collision surface.
  in.require("source");
  in.read_choice("source", source, source_words, "source of the heights: an ESRI ASCII grid, a grey PNG, or a formula");
  in.read_choice("collision", collision, terrain_collision_words,
                 "collision surface: smooth, or triangles as ODE's heightfield or trimesh");
  // Grid and heights of a file.
  in.read_path("file", file, PathUse::read, "ascii, png: relative to this file");
  in.read("cell_m", cell_m, between(HeightGrid::min_cell_m, HeightGrid::max_place_m),
          "distance of neighboring heights; ascii: given in the file");
  read_pair(in, "size_m", size_m, between(HeightGrid::min_cell_m, HeightGrid::max_place_m),
            "slope, sine, fractal: lengths along x and y");
  in.read("vertical_scale", vertical_scale, above(0), "ascii: heights of the file times this are meters");
  in.read("vertical_offset_m", vertical_offset_m, any_number(), "ascii, png: added to the heights");
  in.read("height_min_m", height_min_m, any_number(), "png: height of black");
  in.read("height_max_m", height_max_m, any_number(), "png: height of white");
  in.read_choice("holes", holes, {{"error", Holes::error}, {"nearest", Holes::nearest}, {"linear", Holes::linear}},
                 "ascii: replacement of NODATA; linear: between the ends of the hole in its row and column");
  in.read_choice("origin", origin, {{"center", Origin::center}, {"corner", Origin::corner}, {"map", Origin::map}},
                 "point of the grid at the part's position: its middle, its south-west corner, or map_origin_m");
  read_pair(in, "map_origin_m", map_origin_m, any_number(), "origin map: easting and northing, as in the file");
  // Parameters of generated terrain.
  in.read_deg("angle_deg", angle_rad, between(-80, 80), "slope: inclination");
  in.read_deg("direction_deg", direction_rad, any_number(),
              "slope, sine: direction of ascent, counter-clockwise from +x");
  in.read("amplitude_m", amplitude_m, at_least(0), "sine; fractal: half of the height between lowest and highest");
  in.read("wavelength_m", wavelength_m, between(HeightGrid::min_cell_m, HeightGrid::max_place_m),
          "sine; fractal: of the largest hills");
  in.read("roughness", roughness, between(0, 1), "fractal: height of hills by that of hills twice as long");
  in.read("seed", seed, at_least(0), "fractal: seed of the hills");
  in.read_list("areas", areas, "area", "regions of other materials; the last one has precedence");
  if (in.describing()) return;
  // Check combinations of keys.
  refuse_keys_of_others(in, "source", source_words, source, keys_of_source);
  check_wavelength(in, *this);
  if (is_read_from_file(source) && file.empty())
    in.error("terrain of source " + std::string(word_of(source_words, source)) + " needs the key 'file'");
  if (origin == Origin::map && source != Source::ascii) in.error("origin", "'origin: map' needs 'source: ascii'");
  if (in.has("map_origin_m") && origin != Origin::map) in.error("map_origin_m", "'map_origin_m' needs 'origin: map'");
  if (source == Source::png && height_min_m >= height_max_m) in.error("'height_max_m' must be above 'height_min_m'");
  if (areas.size() > 255) in.error("areas", "'areas' must be at most 255, got " + std::to_string(areas.size()));
}

}  // namespace sim
