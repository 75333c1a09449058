// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

/// What vehicles stand on: a surface without edges, or its triangles as ODE's heightfield or trimesh.
enum class TerrainCollision { smooth, facets, mesh };

inline constexpr ChoiceWords<TerrainCollision> terrain_collision_words{
    {"smooth", TerrainCollision::smooth}, {"facets", TerrainCollision::facets}, {"mesh", TerrainCollision::mesh}};

/// What becomes of heights that a file does not know.
enum class Holes { error, nearest, linear };

/// A region of terrain of another material, in the frame of the terrain, seen from above.
struct TerrainAreaConfig {
  enum class Shape { box, circle, polygon };

  Shape shape = Shape::box;
  std::string material = "default";
  Vector3d center_m = Vector3d::Zero();  ///< z is not used
  Vector3d size_m = Vector3d::Ones();    ///< box; z is not used
  double yaw_rad = 0;                    ///< box
  double radius_m = 1;                   ///< circle
  std::vector<Vector3d> points_m;        ///< polygon: corners; z is 0

  void read(ParamReader& in);
};

/// `terrain:` of a part of shape terrain.
struct TerrainConfig {
  enum class Source { ascii, png, slope, sine, fractal };
  /// What lies at the origin of the part: the middle of the grid, its south-west point, or `map_origin_m`.
  enum class Origin { center, corner, map };

  Source source = Source::slope;
  TerrainCollision collision = TerrainCollision::smooth;
  std::string file;                      ///< ascii, png: relative to the YAML file
  double cell_m = 1;                     ///< all except ascii, whose file gives it
  std::vector<double> size_m{100, 100};  ///< slope, sine, fractal: along x and y
  double vertical_scale = 1;             ///< ascii: its heights times this are metres
  double vertical_offset_m = 0;          ///< ascii, png: added to the heights
  double height_min_m = 0;               ///< png: of black
  double height_max_m = 1;               ///< png: of white
  Holes holes = Holes::error;            ///< ascii
  Origin origin = Origin::center;
  std::vector<double> map_origin_m{0, 0};  ///< origin map: easting and northing of the part's frame
  double angle_rad = 0;                    ///< slope: it climbs to +x
  double direction_rad = 0;                ///< slope, sine: +x of the pattern, counter-clockwise from +x
  double amplitude_m = 1;                  ///< sine; fractal: half of the span of the heights
  double wavelength_m = 10;                ///< sine; fractal: of its largest hills
  double roughness = 0.45;                 ///< fractal: height of each octave by that of the one twice as long
  std::int64_t seed = 1;                   ///< fractal
  std::vector<TerrainAreaConfig> areas;

  SourcePlace place;
  std::string directory;  ///< of the YAML file

  void read(ParamReader& in);
};

/// Of a file, not of a rule.
constexpr bool is_read_from_file(TerrainConfig::Source source) {
  switch (source) {
    case TerrainConfig::Source::ascii:
    case TerrainConfig::Source::png:
      return true;
    case TerrainConfig::Source::slope:
    case TerrainConfig::Source::sine:
    case TerrainConfig::Source::fractal:
      break;
  }
  return false;
}

}  // namespace sim
