// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "devices/ranging/camera.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/image_t.hpp"
#include "sim/base/number.hpp"
#include "sim/image/image_file.hpp"

namespace devices {

namespace {

/// Converts depth to mm, rounded; 0 without a hit or for values above 65535.
sim::Image16 millimeters(const sim::FloatImage& depth_m) {
  sim::Image16 image(depth_m.width, depth_m.height, 1);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    const double mm = 1000.0 * static_cast<double>(depth_m.data[i]);
    if (mm < 65535.5) image.data[i] = static_cast<std::uint16_t>(std::lround(mm));
  }
  return image;
}

template <typename T>
void set_raw(shoal::image_t& message, const sim::Image<T>& image, std::int32_t format) {
  message.pixelformat = format;
  message.row_stride = static_cast<std::int32_t>(sizeof(T)) * image.width * image.channels;
  message.data.resize(image.data.size() * sizeof(T));
  // The formats are little-endian, as are the supported machines (x86 and ARM).
  std::memcpy(message.data.data(), image.data.data(), message.data.size());
}

/// Sets the message to a compressed image.
void set_compressed(shoal::image_t& message, const sim::Bytes& compressed, std::int32_t format) {
  message.pixelformat = format;
  message.row_stride = 0;
  message.data.resize(compressed.size());
  std::memcpy(message.data.data(), compressed.data(), compressed.size());
}

void add_metadata(shoal::image_t& message, const std::string& key, const std::string& value) {
  shoal::image_metadata_t entry{};
  entry.key = key;
  entry.n = static_cast<std::int32_t>(value.size());
  entry.value.assign(value.begin(), value.end());
  message.metadata.push_back(std::move(entry));
}

void set_levels(shoal::image_t& message, const Camera& camera) {
  static thread_local sim::Bytes bytes;
  const sim::Image8& image = camera.levels();
  if (camera.params().encoding == Camera::Encoding::raw)
    return set_raw(message, image, image.channels == 1 ? pixel_format_grey : pixel_format_rgb);
  const bool png = camera.params().encoding == Camera::Encoding::png;
  png ? sim::encode_png(image, bytes) : sim::encode_jpeg(image, camera.params().jpeg_quality, bytes);
  set_compressed(message, bytes, png ? pixel_format_png : pixel_format_mjpeg);
}

void set_16_bits(shoal::image_t& message, const sim::Image16& image, bool png) {
  static thread_local sim::Bytes bytes;
  if (!png) return set_raw(message, image, pixel_format_le_grey16);
  sim::encode_png(image, bytes);
  set_compressed(message, bytes, pixel_format_png);
}

void set_depth(shoal::image_t& message, const Camera& camera) {
  const bool meters = camera.params().encoding == Camera::Encoding::raw;
  if (meters)
    set_raw(message, camera.depth_m(), pixel_format_float_grey32);
  else
    set_16_bits(message, millimeters(camera.depth_m()), camera.params().encoding == Camera::Encoding::png);
  add_metadata(message, "unit", meters ? "m" : "mm");
  add_metadata(message, "depth_along", std::string(word_of(Camera::depth_along_words, camera.params().depth_along)));
}

/// Returns normals as colors: -1 to 1 of x, y, z are 0 to 255 of red, green and blue; black: no surface.
sim::Image8 colors_of(const sim::FloatImage& normals) {
  sim::Image8 image(normals.width, normals.height, 3);
  for (std::size_t i = 0; i + 2 < normals.data.size(); i += 3) {
    const float* normal = normals.data.data() + i;
    if (normal[0] == 0 && normal[1] == 0 && normal[2] == 0) continue;
    for (std::size_t axis = 0; axis < 3; ++axis)
      image.data[i + axis] =
          static_cast<std::uint8_t>(std::lround(127.5F * (1 + std::clamp(normal[axis], -1.0F, 1.0F))));
  }
  return image;
}

void set_normals(shoal::image_t& message, const Camera& camera) {
  static thread_local sim::Bytes bytes;
  add_metadata(message, "frame", "sensor");
  if (camera.params().encoding == Camera::Encoding::raw)
    return set_raw(message, camera.vectors(), pixel_format_float_3);
  sim::encode_png(colors_of(camera.vectors()), bytes);
  set_compressed(message, bytes, pixel_format_png);
}

}  // namespace

// Publishes shoal.image_t, equal on the wire to bot_core's.
void fill(const Camera& camera, shoal::image_t& message) {
  const Camera::Params& params = camera.params();
  // Size and optics of the image.
  message.width = params.optics.width;
  message.height = params.optics.height;
  message.metadata.clear();
  add_metadata(message, "optics", params.optics.text());
  if (camera.baseline_m() > 0) add_metadata(message, "baseline_m", sim::shortest_text(camera.baseline_m()));
  // Pixels in the encoding of the camera.
  switch (params.image) {
    case Camera::Kind::rgb:
    case Camera::Kind::grey:
      set_levels(message, camera);
      break;
    case Camera::Kind::depth:
      set_depth(message, camera);
      break;
    case Camera::Kind::parts:
    case Camera::Kind::vehicles:
      set_16_bits(message, camera.labels(), params.encoding == Camera::Encoding::png);
      add_metadata(message, "labels", camera.label_text());
      break;
    case Camera::Kind::normals:
      set_normals(message, camera);
      break;
    case Camera::Kind::flow:
      set_raw(message, camera.vectors(), pixel_format_float_2);
      add_metadata(message, "unit", "px/s");
      break;
  }
  message.size = static_cast<std::int32_t>(message.data.size());
  message.nmetadata = static_cast<std::int32_t>(message.metadata.size());
}

SHOAL_SENSOR("camera", Camera, shoal::image_t);

}  // namespace devices
