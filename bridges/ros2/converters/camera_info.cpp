// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "bridges/ros2/converters/config_values.hpp"
#include "shoal/image_t.hpp"

namespace bridges::ros2 {
namespace {

/// Reads the lens in the metadata of an image; an empty map when there is none.
sim::ConfigNode lens_of(const shoal::image_t& message) {
  const auto optics = std::find_if(message.metadata.begin(), message.metadata.end(),
                                   [](const auto& entry) { return entry.key == "optics"; });
  if (optics == message.metadata.end()) return {};
  sim::Diagnostics diagnostics;
  return sim::parse_config_text(std::string(optics->value.begin(), optics->value.end()), "optics", diagnostics);
}

/// The lens of a camera of Shoal.  Positions in the image count from the centre of the first pixel, as in OpenCV.
bool write_camera_info(const shoal::image_t& message, std::string_view channel, CdrWriter& out) {
  const sim::ConfigNode lens = lens_of(message);
  const std::vector<double> focal_px = numbers_at(lens, "focal_px"), principal_px = numbers_at(lens, "principal_px");
  if (message.width < 1 || message.height < 1 || focal_px.size() != 2 || principal_px.size() != 2) return false;
  const bool fisheye = text_at(lens, "lens") == "fisheye";
  std::vector<double> distortion = numbers_at(lens, "distortion");
  distortion.resize(fisheye ? 4 : 5);
  const double cx = principal_px[0] - 0.5, cy = principal_px[1] - 0.5;
  put_header(out, message.utime, optical_frame_of(channel));
  out.put(static_cast<std::uint32_t>(message.height));
  out.put(static_cast<std::uint32_t>(message.width));
  out.put(std::string_view(fisheye ? "equidistant" : "plumb_bob"));
  out.put_sequence(std::span<const double>(distortion));
  put_numbers(out, {focal_px[0], 0, cx, 0, focal_px[1], cy, 0, 0, 1});
  put_numbers(out, {1, 0, 0, 0, 1, 0, 0, 0, 1});
  put_numbers(out, {focal_px[0], 0, cx, 0, 0, focal_px[1], cy, 0, 0, 0, 1, 0});
  // No binning, and the region of interest is the whole image.
  for (int i = 0; i < 6; ++i) out.put(std::uint32_t{0});
  out.put(false);
  return true;
}

SHOAL_ROS2_CONVERTER(write_camera_info, "sensor_msgs/msg/CameraInfo", "camera_info");

}  // namespace
}  // namespace bridges::ros2
