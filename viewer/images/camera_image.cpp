// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/images/camera_image.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "devices/ranging/camera.hpp"
#include "sim/image/image_file.hpp"

namespace viewer {

namespace {

std::string metadata_of(const shoal::image_t& message, const std::string& key) {
  for (const shoal::image_metadata_t& entry : message.metadata)
    if (entry.key == key) return {entry.value.begin(), entry.value.end()};
  return {};
}

/// Copies rows of `row_stride` bytes, without their padding.
template <typename T>
sim::Image<T> raw_image(const shoal::image_t& message, int channels) {
  sim::Image<T> image(message.width, message.height, channels);
  const std::size_t row = sizeof(T) * static_cast<std::size_t>(message.width) * static_cast<std::size_t>(channels);
  const auto stride = static_cast<std::size_t>(std::max(0, message.row_stride));
  const auto height = static_cast<std::size_t>(message.height);
  if (stride < row || message.data.size() < stride * (height - 1) + row)
    throw std::runtime_error(fmt::format("the image of {} x {} pixels has {} bytes in rows of {}", message.width,
                                         message.height, message.data.size(), message.row_stride));
  for (std::size_t i = 0; i < height; ++i)
    std::memcpy(image.at(0, static_cast<int>(i)), message.data.data() + i * stride, row);
  return image;
}

sim::Image8 displayable_16_bits(const shoal::image_t& message, const sim::Image16& image) {
  if (!metadata_of(message, "labels").empty()) return sim::label_image(image);
  sim::FloatImage depth_m(image.width, image.height, 1);
  for (std::size_t i = 0; i < image.data.size(); ++i) depth_m.data[i] = 1e-3F * static_cast<float>(image.data[i]);
  return sim::depth_image(depth_m);
}

}  // namespace

sim::Image8 displayable(const shoal::image_t& message) {
  using namespace devices;
  // Check the size.
  const bool sides = message.width >= 1 && message.height >= 1 && message.width <= sim::max_image_side_px &&
                     message.height <= sim::max_image_side_px;
  if (!sides || std::int64_t{message.width} * message.height > sim::max_image_pixels)
    throw std::runtime_error(fmt::format("the image has an invalid size: {} x {}", message.width, message.height));
  const auto bytes = std::as_bytes(std::span(message.data));
  // Convert by pixel format.
  switch (message.pixelformat) {
    case pixel_format_grey:
      return raw_image<std::uint8_t>(message, 1);
    case pixel_format_rgb:
      return raw_image<std::uint8_t>(message, 3);
    case pixel_format_le_grey16:
      return displayable_16_bits(message, raw_image<std::uint16_t>(message, 1));
    case pixel_format_float_grey32:
      return sim::depth_image(raw_image<float>(message, 1));
    case pixel_format_mjpeg:
      return sim::decode_image(bytes);
    case pixel_format_png:
      if (!metadata_of(message, "labels").empty() || metadata_of(message, "unit") == "mm")
        return displayable_16_bits(message, sim::decode_png16(bytes));
      return sim::decode_image(bytes);
    default:
      throw std::runtime_error(
          fmt::format("pixel format {} cannot be drawn; grey, RGB, 16-bit grey, float grey, JPEG and PNG can",
                      message.pixelformat));
  }
}

}  // namespace viewer
