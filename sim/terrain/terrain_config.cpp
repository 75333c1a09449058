// SPDX-License-Identifier: BSD-3-Clause
#include "sim/terrain/terrain_config.hpp"

#include <algorithm>
#include <filesystem>
#include <initializer_list>

#include "sim/config/message_text.hpp"
#include "sim/config/read_points.hpp"
#include "sim/terrain/height_grid.hpp"

namespace sim {
namespace {

/// Two numbers.
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

/// A key that says nothing of this kind would do nothing; it is most likely meant for another.
void only_for(ParamReader& in, const char* key, const std::string& kind, std::initializer_list<const char*> kinds,
              const char* what) {
  if (in.has(key) && std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    in.error(key, "'" + std::string(key) + "' is not for " + what + " " + kind);
}

}  // namespace

void TerrainAreaConfig::read(ParamReader& in) {
  in.read_choice("shape", shape, {"box", "circle", "polygon"}, "outline, seen from above");
  in.require("material");
  in.read_reference("material", material, "material", "what the ground is made of inside");
  read_pair(in, "center_m", center_m, any_number(), "box, circle: middle, in the frame of the terrain");
  read_pair(in, "size_m", size_m, above(0), "box: lengths along x and y");
  in.read_deg("yaw_deg", yaw_rad, any_number(), "box: turned counter-clockwise");
  in.read("radius_m", radius_m, above(0), "circle");
  read_points(in, "points_m", points_m, 2, "polygon: three or more corners, in order");
  if (in.describing()) return;
  only_for(in, "center_m", shape, {"box", "circle"}, "shape");
  only_for(in, "size_m", shape, {"box"}, "shape");
  only_for(in, "yaw_deg", shape, {"box"}, "shape");
  only_for(in, "radius_m", shape, {"circle"}, "shape");
  only_for(in, "points_m", shape, {"polygon"}, "shape");
  if (shape == "polygon" && points_m.size() < 3)
    in.error("points_m", "'points_m' must have at least 3 corners, got " + std::to_string(points_m.size()));
}

namespace {

void check_keys_of_source(ParamReader& in, const std::string& source) {
  const auto keys_of = [&](std::initializer_list<const char*> keys, std::initializer_list<const char*> sources) {
    for (const char* key : keys) only_for(in, key, source, sources, "source");
  };
  keys_of({"file", "vertical_offset_m"}, {"ascii", "png"});
  keys_of({"cell_m"}, {"png", "slope", "sine", "fractal"});
  keys_of({"size_m"}, {"slope", "sine", "fractal"});
  keys_of({"vertical_scale", "holes", "map_origin_m"}, {"ascii"});
  keys_of({"height_min_m", "height_max_m"}, {"png"});
  keys_of({"angle_deg"}, {"slope"});
  keys_of({"direction_deg"}, {"slope", "sine"});
  keys_of({"amplitude_m", "wavelength_m"}, {"sine", "fractal"});
  keys_of({"roughness", "seed"}, {"fractal"});
}

/// Waves that the grid is too coarse for would come out flat or as other waves.
void check_wavelength(ParamReader& in, const TerrainConfig& config) {
  const double cells = config.source == "sine" ? 2 : config.source == "fractal" ? 4 : 0;
  if (config.wavelength_m >= cells * config.cell_m) return;
  in.error(in.has("wavelength_m") ? "wavelength_m" : "cell_m",
           "'wavelength_m' of a " + config.source + " must be at least " + number_text(cells) +
               " times 'cell_m', got " + number_text(config.wavelength_m) + " and " + number_text(config.cell_m));
}

}  // namespace

void TerrainConfig::read(ParamReader& in) {
  if (!in.describing()) {
    place = in.node()->place;
    if (place.file) directory = std::filesystem::path(*place.file).parent_path().string();
  }
  in.require("source");
  in.read_choice("source", source, {"ascii", "png", "slope", "sine", "fractal"},
                 "where heights come from: an ESRI ASCII grid, a grey PNG, or a rule");
  in.read_choice("collision", collision, {"smooth", "facets", "mesh"},
                 "what vehicles stand on: a surface without edges, or its triangles as ODE's heightfield or trimesh");
  in.read_path("file", file, PathUse::read, "ascii, png: relative to this file");
  in.read("cell_m", cell_m, between(HeightGrid::min_cell_m, HeightGrid::max_place_m),
          "distance of neighbouring heights; ascii: the file says it");
  read_pair(in, "size_m", size_m, between(HeightGrid::min_cell_m, HeightGrid::max_place_m),
            "slope, sine, fractal: lengths along x and y");
  in.read("vertical_scale", vertical_scale, above(0), "ascii: heights of the file times this are metres");
  in.read("vertical_offset_m", vertical_offset_m, any_number(), "ascii, png: added to the heights");
  in.read("height_min_m", height_min_m, any_number(), "png: height of black");
  in.read("height_max_m", height_max_m, any_number(), "png: height of white");
  in.read_choice("holes", holes, {"error", "nearest", "linear"},
                 "ascii: what NODATA becomes; linear: between the ends of the hole in its row and column");
  in.read_choice("origin", origin, {"center", "corner", "map"},
                 "what lies at the part's place: the middle of the grid, its south-west point, or map_origin_m");
  read_pair(in, "map_origin_m", map_origin_m, any_number(), "origin map: easting and northing, as in the file");
  in.read_deg("angle_deg", angle_rad, between(-80, 80), "slope: how steeply it climbs");
  in.read_deg("direction_deg", direction_rad, any_number(),
              "slope, sine: where it climbs to, counter-clockwise from +x");
  in.read("amplitude_m", amplitude_m, at_least(0), "sine; fractal: half of the height between lowest and highest");
  in.read("wavelength_m", wavelength_m, between(HeightGrid::min_cell_m, HeightGrid::max_place_m),
          "sine; fractal: of the largest hills");
  in.read("roughness", roughness, between(0, 1), "fractal: height of hills by that of hills twice as long");
  in.read("seed", seed, at_least(0), "fractal: other seed, other hills");
  in.read_list("areas", areas, "area", "regions of other materials, the last wins");
  if (in.describing()) return;
  check_keys_of_source(in, source);
  check_wavelength(in, *this);
  if ((source == "ascii" || source == "png") && file.empty())
    in.error("terrain of source " + source + " needs the key 'file'");
  if (origin == "map" && source != "ascii") in.error("origin", "'origin' map is for source ascii");
  if (in.has("map_origin_m") && origin != "map") in.error("map_origin_m", "'map_origin_m' needs 'origin: map'");
  if (source == "png" && height_min_m >= height_max_m) in.error("'height_max_m' must be above 'height_min_m'");
  if (areas.size() > 255) in.error("areas", "'areas' must be at most 255, got " + std::to_string(areas.size()));
}

}  // namespace sim
