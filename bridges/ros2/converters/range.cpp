// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/sonar_range_t.hpp"

namespace bridges::ros2 {
namespace {

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
