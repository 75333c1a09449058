// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "sim/image/image_file.hpp"
#include "sim/random/random.hpp"

namespace colored_images {

/// Smooth, so that JPEG keeps it well.
inline sim::Image8 colors(int width, int height, int channels) {
  sim::Image8 image(width, height, channels);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      for (int channel = 0; channel < channels; ++channel)
        image.at(column, row)[channel] = static_cast<std::uint8_t>((2 * column + 3 * row + 50 * channel) % 200);
  return image;
}

inline sim::Bytes png_of(const sim::Image8& image) {
  sim::Bytes bytes;
  sim::encode_png(image, bytes);
  return bytes;
}

inline std::string error_of(std::span<const std::byte> bytes) {
  try {
    sim::decode_image(bytes);
    return "";
  } catch (const sim::ImageError& error) {
    return error.what();
  }
}

}  // namespace colored_images
