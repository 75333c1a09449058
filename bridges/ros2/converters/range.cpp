// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/sonar_range_t.hpp"

namespace bridges::ros2 {
namespace {

/// The limits and the opening angle are not in the message.  Without an echo the range is infinite, by REP 117.
bool write_range(const shoal::sonar_range_t& message, std::string_view channel, CdrWriter& out) {
  constexpr float infinite = std::numeric_limits<float>::infinity();
  constexpr std::uint8_t ultrasound = 0;
  put_header(out, message.utime, frame_of(channel));
  out.put(ultrasound);
  for (const float value : {0.0f, 0.0f, infinite}) out.put(value);  // opening angle, limits
  out.put(message.valid != 0 ? static_cast<float>(message.range_m) : infinite);
  out.put(0.0f);  // variance unknown
  return true;
}

SHOAL_ROS2_CONVERTER(write_range, "sensor_msgs/msg/Range", "range");

}  // namespace
}  // namespace bridges::ros2
