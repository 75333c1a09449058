// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/compass_t.hpp"

namespace bridges::ros2 {
namespace {

bool write_field(const shoal::compass_t& message, std::string_view channel, CdrWriter& out) {
  constexpr double tesla_per_uT = 1e-6;
  put_header(out, message.utime, frame_of(channel));
  for (const double field_uT : message.field_uT) out.put(field_uT * tesla_per_uT);
  out.put_array(std::span<const double>(unknown_3x3));
  return true;
}

SHOAL_ROS2_CONVERTER(write_field, "sensor_msgs/msg/MagneticField", "field");

}  // namespace
}  // namespace bridges::ros2
