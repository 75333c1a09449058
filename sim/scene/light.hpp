// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

/// Section `light:` of a world: sun and sky, for images.  Strengths are relative to a white surface that appears white.
struct LightConfig {
  double sun_azimuth_rad = degrees_to_radians(125);   ///< clockwise from north (+y), as on a compass
  double sun_elevation_rad = degrees_to_radians(45);  ///< above the horizon; negative: no sunlight
  double sun = 0.9;                                   ///< strength on a surface that faces the sun
  double sky = 0.4;                                   ///< strength on a surface that faces the unobstructed sky
  std::string zenith_color = "#5b8fd6";
  std::string horizon_color = "#d6e4f0";
  bool shadows = true;

  void read(ParamReader& in);
  /// Returns the unit vector from the ground to the sun.
  Vector3d to_sun_W() const;
};

/// Red, green and blue, sRGB-encoded as in files.
using Color = std::array<std::uint8_t, 3>;

/// Parses `#rrggbb`; returns empty for other texts.
std::optional<Color> parse_color(const std::string& text);

}  // namespace sim
