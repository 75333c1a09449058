// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/dvl_t.hpp"

namespace bridges::ros2 {
namespace {

/// Velocity over the bottom in the axes of the sensor; no message without bottom lock.
bool write_velocity(const shoal::dvl_t& message, std::string_view channel, CdrWriter& out) {
  if (message.bottom_lock == 0) return false;
  put_header(out, message.utime, frame_of(channel));
  put_numbers(out, message.velocity_mps);
  put_numbers(out, {0, 0, 0});
  const double variance = message.fom_mps * message.fom_mps;
  put_position_covariance(out, std::array<double, 9>{variance, 0, 0, 0, variance, 0, 0, 0, variance});
  return true;
}

SHOAL_ROS2_CONVERTER(write_velocity, "geometry_msgs/msg/TwistWithCovarianceStamped", "velocity");

}  // namespace
}  // namespace bridges::ros2
