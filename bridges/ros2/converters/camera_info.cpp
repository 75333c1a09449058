// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/image_t.hpp"
#include "sim/base/number.hpp"
#include "sim/config/config_node.hpp"

namespace bridges::ros2 {
namespace {

/// Returns an entry of the metadata of an image; empty when there is none.
std::string metadata_of(const shoal::image_t& message, std::string_view key) {
  const auto found = std::find_if(message.metadata.begin(), message.metadata.end(),
                                  [key](const auto& entry) { return entry.key == key; });
  return found == message.metadata.end() ? std::string() : std::string(found->value.begin(), found->value.end());
}

/// Reads the lens in the metadata of an image; an empty map when there is none.
sim::ConfigNode lens_of(const shoal::image_t& message) {
  sim::Diagnostics diagnostics;
  return sim::parse_config_text(metadata_of(message, "optics"), "optics", diagnostics);
}

/// Returns the distance to the left camera of a stereo pair, m; 0 for a camera that is not the right one of a pair.
double baseline_of(const shoal::image_t& message) {
  const double baseline_m = sim::read_number(metadata_of(message, "baseline_m")).value_or(0);
  return std::isfinite(baseline_m) ? baseline_m : 0;
}

/// Returns the numbers of a list in the lens, with 0 for what is none.
std::vector<double> lens_numbers(const sim::ConfigNode& lens, std::string_view key) {
  std::vector<double> numbers;
  if (const sim::ConfigNode* list = lens.find(key))
    for (const sim::ConfigNode& item : list->items) {
      const double number = sim::read_number(item.scalar).value_or(0);
      numbers.push_back(std::isfinite(number) ? number : 0);
    }
  return numbers;
}

/// The lens of a camera of Shoal.  Positions in the image count from the center of the first pixel, as in OpenCV.
bool write_camera_info(const shoal::image_t& message, std::string_view channel, CdrWriter& out) {
  const sim::ConfigNode lens = lens_of(message);
  const std::vector<double> focal_px = lens_numbers(lens, "focal_px"),
                            principal_px = lens_numbers(lens, "principal_px");
  if (message.width < 1 || message.height < 1 || focal_px.size() != 2 || principal_px.size() != 2) return false;
  const sim::ConfigNode* kind = lens.find("lens");
  const bool fisheye = kind != nullptr && kind->scalar == "fisheye";
  std::vector<double> distortion = lens_numbers(lens, "distortion");
  distortion.resize(fisheye ? 4 : 5);
  const double cx = principal_px[0] - 0.5, cy = principal_px[1] - 0.5;
  put_header(out, message.utime, optical_frame_of(channel));
  out.put(static_cast<std::uint32_t>(message.height));
  out.put(static_cast<std::uint32_t>(message.width));
  out.put(std::string_view(fisheye ? "equidistant" : "plumb_bob"));
  out.put_sequence(std::span<const double>(distortion));
  put_numbers(out, {focal_px[0], 0, cx, 0, focal_px[1], cy, 0, 0, 1});
  put_numbers(out, {1, 0, 0, 0, 1, 0, 0, 0, 1});
  // -fx B for the right camera of a pair, as sensor_msgs/CameraInfo defines it; never -0.
  const double shift_px_m = 0.0 - focal_px[0] * baseline_of(message);
  put_numbers(out, {focal_px[0], 0, cx, shift_px_m, 0, focal_px[1], cy, 0, 0, 0, 1, 0});
  // No binning, and the region of interest is the whole image.
  for (int i = 0; i < 6; ++i) out.put(std::uint32_t{0});
  out.put(false);
  return true;
}

SHOAL_ROS2_CONVERTER(write_camera_info, "sensor_msgs/msg/CameraInfo", "camera_info");

}  // namespace
}  // namespace bridges::ros2
