// SPDX-License-Identifier: BSD-3-Clause
#include "sim/image/image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sim {

namespace {

/// Size of the table: one entry spans at most 255 * 12.92 / 16384 = 0.2 levels, at the dark end.
constexpr int srgb_steps = 16384;

struct SrgbTables {
  std::array<float, 256> linear;
  std::array<std::uint8_t, srgb_steps + 1> level;

  SrgbTables() {
    for (std::size_t i = 0; i < linear.size(); ++i) {
      const double s = static_cast<double>(i) / 255;
      linear[i] = static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
    }
    for (std::size_t i = 0; i < level.size(); ++i) {
      const double light = static_cast<double>(i) / srgb_steps;
      const double s = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
      level[i] = static_cast<std::uint8_t>(std::lround(255 * s));
    }
  }
};

const SrgbTables tables;

}  // namespace

float linear_from_srgb(std::uint8_t level) {
  return tables.linear[level];
}

std::uint8_t srgb_from_linear(float light) {
  if (!(light > 0)) return 0;  // NaN too
  if (light >= 1) return 255;
  return tables.level[static_cast<std::size_t>(light * srgb_steps + 0.5F)];
}

Image8 depth_image(const FloatImage& depth_m) {
  float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
  for (const float depth : depth_m.data)
    if (depth > 0 && std::isfinite(depth)) nearest = std::min(nearest, depth), farthest = std::max(farthest, depth);
  Image8 shown(depth_m.width, depth_m.height, 1);
  // Logarithmic, since the interesting detail is near; black (0) is left to pixels without a depth.
  const float span = farthest > nearest ? std::log(farthest / nearest) : 1;
  for (std::size_t i = 0; i < shown.data.size(); ++i) {
    const float depth = depth_m.data[i];
    if (depth > 0 && std::isfinite(depth))
      shown.data[i] = static_cast<std::uint8_t>(std::lround(255 - 215 * std::log(depth / nearest) / span));
  }
  return shown;
}

std::array<std::uint8_t, 3> label_color(std::uint16_t label) {
  if (label == 0) return {0, 0, 0};
  // Steps of the golden ratio around the hue circle separate successive labels; value and saturation vary too.
  const std::uint32_t step = label * 2654435769U;  // 2^32 / golden ratio
  const double hue = 6.0 * step / 4294967296.0;
  const double value = 1.0 - 0.18 * (label % 3), grey = 0.25 + 0.15 * (label / 3 % 2);
  const auto channel = [&](double shift) {
    const double around = std::fmod(hue + shift, 6.0);
    const double share = std::clamp(std::abs(around - 3) - 1, 0.0, 1.0);
    return static_cast<std::uint8_t>(std::lround(255 * value * (grey + (1 - grey) * share)));
  };
  return {channel(0), channel(4), channel(2)};
}

Image8 label_image(const Image16& labels) {
  Image8 shown(labels.width, labels.height, 3);
  for (std::size_t i = 0; i < labels.data.size(); ++i) {
    const auto color = label_color(labels.data[i]);
    std::copy(color.begin(), color.end(), shown.data.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return shown;
}

}  // namespace sim
