// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/image_t.hpp"
#include "shoal/sonar_image_t.hpp"

namespace bridges::ros2 {
namespace {

struct RawFormat {
  std::int32_t pixelformat;
  std::int64_t pixel_bytes;
  const char* encoding;
};

constexpr std::int32_t format_mjpeg = 1196444237;
constexpr std::int32_t format_png = 'P' | 'N' << 8 | 'G' << 16 | ' ' << 24;
constexpr std::int32_t format_16 = 909199180;
constexpr std::int32_t format_float = 842221382;
/// FourCC codes of bot_core, and the encodings of sensor_msgs/image_encodings.hpp.
constexpr RawFormat raw_formats[] = {{1497715271, 1, "mono8"},   {859981650, 3, "rgb8"},  {format_16, 2, "mono16"},
                                     {format_float, 4, "32FC1"}, {844641094, 8, "32FC2"}, {861418310, 12, "32FC3"}};

void put_image(CdrWriter& out, std::int32_t height, std::int32_t width, const char* encoding, std::int32_t step,
               std::span<const std::uint8_t> data) {
  out.put(static_cast<std::uint32_t>(height));
  out.put(static_cast<std::uint32_t>(width));
  out.put(std::string_view(encoding));
  out.put(std::uint8_t{0});  // little-endian
  out.put(static_cast<std::uint32_t>(step));
  out.put_sequence(data);
}

/// Returns whether 16-bit pixels are depths in mm (REP 118) or labels, and no brightness.
bool is_number_image(const shoal::image_t& message) {
  return (message.pixelformat == format_16 || message.pixelformat == format_png) &&
         std::any_of(message.metadata.begin(), message.metadata.end(),
                     [](const auto& entry) { return entry.key == "unit" || entry.key == "labels"; });
}

bool write_image(const shoal::image_t& message, std::string_view channel, CdrWriter& out) {
  for (const RawFormat& format : raw_formats) {
    if (format.pixelformat != message.pixelformat) continue;
    const bool fits = message.width >= 0 && message.height >= 0 &&
                      message.row_stride >= message.width * format.pixel_bytes &&
                      message.size == std::int64_t{message.height} * message.row_stride;
    if (!fits) return false;
    put_header(out, message.utime, optical_frame_of(channel));
    // raw16 holds depths in mm, which ROS names by the number type alone.
    put_image(out, message.height, message.width, is_number_image(message) ? "16UC1" : format.encoding,
              message.row_stride, message.data);
    return true;
  }
  return false;
}

bool write_compressed(const shoal::image_t& message, std::string_view channel, CdrWriter& out) {
  const bool jpeg = message.pixelformat == format_mjpeg;
  if (!jpeg && message.pixelformat != format_png) return false;
  put_header(out, message.utime, optical_frame_of(channel));
  out.put(std::string_view(jpeg ? "jpeg" : is_number_image(message) ? "16UC1; png compressed " : "png"));
  out.put_sequence(std::span<const std::uint8_t>(message.data));
  return true;
}

/// Echo levels over range (rows, nearest first) and bearing (columns).
bool write_sonar_image(const shoal::sonar_image_t& message, std::string_view channel, CdrWriter& out) {
  const bool fits =
      message.nbins >= 0 && message.nbeams >= 0 && message.size == std::int64_t{message.nbins} * message.nbeams;
  if (!fits) return false;
  put_header(out, message.utime, frame_of(channel));
  put_image(out, message.nbins, message.nbeams, "mono8", message.nbeams, message.data);
  return true;
}

SHOAL_ROS2_CONVERTER(write_image, "sensor_msgs/msg/Image", "image");
SHOAL_ROS2_CONVERTER(write_compressed, "sensor_msgs/msg/CompressedImage", "compressed");
SHOAL_ROS2_CONVERTER(write_sonar_image, "sensor_msgs/msg/Image", "image");

}  // namespace
}  // namespace bridges::ros2
