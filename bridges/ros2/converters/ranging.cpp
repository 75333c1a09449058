// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/planar_lidar_t.hpp"
#include "shoal/sonar_range_t.hpp"

namespace bridges::ros2 {
namespace {

/// Ranges by REP 117: without a return the scanner reports its largest range, which is +inf here, and its least one of
/// what is nearer, which is -inf.
bool write_scan(const shoal::planar_lidar_t& message, std::string_view channel, ConverterContext& context,
                CdrWriter& out) {
  constexpr float infinite = std::numeric_limits<float>::infinity();
  const ConverterContext::Device& device = context.device_of(channel);
  put_header(out, message.utime, frame_of(channel));
  const auto steps = static_cast<float>(message.nranges > 0 ? message.nranges - 1 : 0);
  out.put(message.rad0);
  out.put(message.rad0 + message.radstep * steps);
  out.put(message.radstep);
  // All beams are measured at one instant; the time between scans is not in the message.
  for (const float value : {0.0f, 0.0f, device.range_min_m, device.range_max_m}) out.put(value);
  std::vector<float> ranges_m = message.ranges;
  for (float& range_m : ranges_m) {
    if (range_m >= device.range_max_m) range_m = infinite;
    if (range_m <= device.range_min_m && device.range_min_m > 0) range_m = -infinite;
  }
  out.put_sequence(std::span<const float>(ranges_m));
  out.put_sequence(std::span<const float>(message.intensities));
  return true;
}

SHOAL_ROS2_CONVERTER(write_scan, "sensor_msgs/msg/LaserScan", "scan");

/// Without an echo the range is infinite, by REP 117.  The standard message is along +x of its frame.
bool write_range(const shoal::sonar_range_t& message, std::string_view channel, ConverterContext& context,
                 CdrWriter& out) {
  constexpr float infinite = std::numeric_limits<float>::infinity();
  constexpr std::uint8_t ultrasound = 0;
  const ConverterContext::Device& device = context.device_of(channel);
  put_header(out, message.utime, frame_of(channel) + (device.is_turned() ? beam_ending : ""));
  out.put(ultrasound);
  for (const float value : {device.opening_rad, device.range_min_m, device.range_max_m}) out.put(value);
  out.put(message.valid != 0 ? static_cast<float>(message.range_m) : infinite);
  out.put(0.0f);  // variance unknown
  return true;
}

SHOAL_ROS2_CONVERTER(write_range, "sensor_msgs/msg/Range", "range");

}  // namespace
}  // namespace bridges::ros2
