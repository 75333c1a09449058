// SPDX-License-Identifier: BSD-3-Clause
#include "sim/camera/sky_light.hpp"

namespace sim {

SkyLight::SkyLight(const LightConfig& light)
    : to_sun_W_(light.to_sun_W().cast<float>()),
      sun_is_up_(light.to_sun_W().z() > 0 && light.sun > 0),
      // Slightly warmer than the sky.
      sun_(LinearColor(1.0F, 0.97F, 0.91F) * static_cast<float>(light.sun)),
      zenith_(linear_color(parse_color(light.zenith_color).value_or(Color{}))),
      horizon_(linear_color(parse_color(light.horizon_color).value_or(Color{}))),
      ground_(linear_color({118, 116, 110})) {}

}  // namespace sim
