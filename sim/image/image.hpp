// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/state/state_archive.hpp"

namespace sim {

/// Maximum size of images, in files and of cameras.
inline constexpr int max_image_side_px = 8192;
inline constexpr int max_image_pixels = 16'000'000;

/// Pixel values in row-major order from the top left corner, channels interleaved.
template <typename T>
struct Image {
  int width = 0;
  int height = 0;
  int channels = 1;
  std::vector<T> data;

  Image() = default;
  Image(int width_, int height_, int channels_) : width(width_), height(height_), channels(channels_), data(size()) {}

  std::size_t size() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(channels);
  }
  T* at(int column, int row) { return data.data() + offset(column, row); }
  const T* at(int column, int row) const { return data.data() + offset(column, row); }

  void visit_state(StateArchive& archive) {
    archive(width, height, channels, data);
    if (archive.restoring() && (width < 0 || height < 0 || channels < 0 || data.size() != size()))
      archive.fail("an image whose number of values differs from that of its pixels");
  }

 private:
  std::size_t offset(int column, int row) const {
    return (static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)) *
           static_cast<std::size_t>(channels);
  }
};

/// Grey or RGB with sRGB encoding, as in image files.
using Image8 = Image<std::uint8_t>;
/// Depth in mm, or labels.
using Image16 = Image<std::uint16_t>;
/// Linear light (RGB, 1 is white), or depth in m.
using FloatImage = Image<float>;

/// Converts an sRGB level to linear light, 0 to 1 (IEC 61966-2-1).
float linear_from_srgb(std::uint8_t level);
/// Converts linear light to an sRGB level; the light is clamped to 0 .. 1.
std::uint8_t srgb_from_linear(float light);
/// Returns the luminance of linear RGB (ITU-R BT.709).
inline float luminance(const float* rgb) {
  return 0.2126F * rgb[0] + 0.7152F * rgb[1] + 0.0722F * rgb[2];
}

/// Returns a depth image for display on a logarithmic scale from the nearest (bright) to the farthest; black: no hit.
Image8 depth_image(const FloatImage& depth_m);
/// Returns a label image for display, with one color per label; label 0 is black.
Image8 label_image(const Image16& labels);
/// Returns the display color of a label, the same in every image.
std::array<std::uint8_t, 3> label_color(std::uint16_t label);

}  // namespace sim
