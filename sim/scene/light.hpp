// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/base/math.hpp"
#include "sim/config/param_reader.hpp"

namespace sim {

/// `light:` of a world: a sun and the sky, for images.  Strengths are what a white surface sends back: 1 is white.
struct LightConfig {
  double sun_azimuth_rad = degrees_to_radians(125);   ///< clockwise from north (+y), as on a compass
  double sun_elevation_rad = degrees_to_radians(45);  ///< over the horizon; below it there is no sun
  double sun = 0.9;                                   ///< on a surface that faces the sun
  double sky = 0.4;                                   ///< on a surface that faces an open sky
  std::string zenith_color = "#5b8fd6";
  std::string horizon_color = "#d6e4f0";
  bool shadows = true;

  void read(ParamReader& in);
  /// Unit vector from the ground to the sun.
  Vector3d to_sun_W() const;
};

}  // namespace sim
