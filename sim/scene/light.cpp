// SPDX-License-Identifier: BSD-3-Clause
#include "sim/scene/light.hpp"

#include <charconv>

namespace sim {

void LightConfig::read(ParamReader& in) {
  in.read_deg("sun_azimuth_deg", sun_azimuth_rad, between(-360, 360), "azimuth of the sun, clockwise from north");
  in.read_deg("sun_elevation_deg", sun_elevation_rad, between(-90, 90),
              "elevation of the sun; below 0 there is no sun");
  in.read("sun", sun, between(0, 100), "strength of the sun; 1: a white surface that faces it is white");
  in.read("sky", sky, between(0, 100), "strength of the light of the sky, which makes no shadows");
  in.read("zenith_color", zenith_color, "color of the sky overhead, #rrggbb");
  in.read("horizon_color", horizon_color, "color of the sky at the horizon, #rrggbb");
  in.read("shadows", shadows, "parts cast shadows on each other");
  if (in.describing()) return;
  for (const auto& [key, color] :
       {std::pair("zenith_color", &zenith_color), std::pair("horizon_color", &horizon_color)})
    if (!parse_color(*color)) in.error(key, std::string("'") + key + "' must look like #rrggbb, got '" + *color + "'");
}

Vector3d LightConfig::to_sun_W() const {
  const double level = std::cos(sun_elevation_rad);
  return {level * std::sin(sun_azimuth_rad), level * std::cos(sun_azimuth_rad), std::sin(sun_elevation_rad)};
}

std::optional<Color> parse_color(const std::string& text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  Color color;
  for (std::size_t i = 0; i < 3; ++i) {
    const char* begin = text.data() + 1 + 2 * i;
    const auto [end, error] = std::from_chars(begin, begin + 2, color[i], 16);
    if (error != std::errc{} || end != begin + 2) return std::nullopt;
  }
  return color;
}

}  // namespace sim
