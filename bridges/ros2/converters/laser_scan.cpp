// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/planar_lidar_t.hpp"

namespace bridges::ros2 {
namespace {

bool write_scan(const shoal::planar_lidar_t& message, std::string_view channel, CdrWriter& out) {
  put_header(out, message.utime, frame_of(channel));
  const auto steps = static_cast<float>(message.nranges > 0 ? message.nranges - 1 : 0);
  out.put(message.rad0);
  out.put(message.rad0 + message.radstep * steps);
  out.put(message.radstep);
  // Time between beams, time of the scan and limits of the range are not in the message.
  for (const float unknown : {0.0f, 0.0f, 0.0f, std::numeric_limits<float>::infinity()}) out.put(unknown);
  out.put_sequence(std::span<const float>(message.ranges));
  out.put_sequence(std::span<const float>(message.intensities));
  return true;
}

SHOAL_ROS2_CONVERTER(write_scan, "sensor_msgs/msg/LaserScan", "scan");

}  // namespace
}  // namespace bridges::ros2
