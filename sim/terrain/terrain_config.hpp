// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

/// Collision surface: smooth, or triangles as ODE's heightfield (facets) or trimesh (mesh).
enum class TerrainCollision { smooth, facets, mesh };

inline constexpr ChoiceWords<TerrainCollision> terrain_collision_words{
    {"smooth", TerrainCollision::smooth}, {"facets", TerrainCollision::facets}, {"mesh", TerrainCollision::mesh}};

/// Treatment of missing heights (NODATA) in a file: an error, or filled by the nearest height or linearly.
enum class Holes { error, nearest, linear };

/// Region of terrain with another material: outline in the xy-plane of the frame of the terrain.
struct TerrainAreaConfig {
  /// Outline of the region.
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

/// Section `terrain:` of a part of shape terrain.
struct TerrainConfig {
  /// Source of the heights: ESRI ASCII grid, grey PNG, or a formula.
  enum class Source { ascii, png, slope, sine, fractal };
  /// Point at the origin of the part: center of the grid, its south-west point, or `map_origin_m`.
  enum class Origin { center, corner, map };

  Source source = Source::slope;
  TerrainCollision collision = TerrainCollision::smooth;
  std::string file;                      ///< ascii, png: relative to the YAML file
  double cell_m = 1;                     ///< spacing of points; ascii: given in the file
  std::vector<double> size_m{100, 100};  ///< slope, sine, fractal: lengths along x and y
  double vertical_scale = 1;             ///< ascii: factor from heights in the file to meters
  double vertical_offset_m = 0;          ///< ascii, png: added to the heights
  double height_min_m = 0;               ///< png: height of black
  double height_max_m = 1;               ///< png: height of white
  Holes holes = Holes::error;            ///< ascii
  Origin origin = Origin::center;
  std::vector<double> map_origin_m{0, 0};  ///< origin map: easting and northing of the part's frame
  double angle_rad = 0;                    ///< slope: inclination, rising towards direction_rad
  double direction_rad = 0;                ///< slope, sine: direction of variation, counter-clockwise from +x
  double amplitude_m = 1;                  ///< sine: amplitude; fractal: half of the range of heights
  double wavelength_m = 10;                ///< sine: wavelength; fractal: of the longest octave
  double roughness = 0.45;                 ///< fractal: ratio of the amplitudes of successive octaves
  std::int64_t seed = 1;                   ///< fractal
  std::vector<TerrainAreaConfig> areas;

  SourcePlace place;
  std::string directory;  ///< directory of the YAML file

  void read(ParamReader& in);
};

/// Returns true when heights are read from a file, false when they are generated.
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
