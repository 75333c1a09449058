// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/estimate_t.hpp"

namespace bridges::ros2 {
namespace {

/// Only the yaw of the rotation is estimated; its variance is not in the message.
bool write_estimate(const shoal::estimate_t& message, std::string_view, CdrWriter& out) {
  put_header(out, message.utime, world_frame);
  put_numbers(out, message.position_m);
  put_numbers(out, {0, 0, std::sin(message.yaw_rad / 2), std::cos(message.yaw_rad / 2)});
  put_position_covariance(out, message.covariance_m2);
  return true;
}

SHOAL_ROS2_CONVERTER(write_estimate, "geometry_msgs/msg/PoseWithCovarianceStamped", "pose");

}  // namespace
}  // namespace bridges::ros2
