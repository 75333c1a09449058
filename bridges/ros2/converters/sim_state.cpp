// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/sim_state_t.hpp"

namespace bridges::ros2 {
namespace {

/// True poses of all vehicles, as transforms from the world frame.
bool write_transforms(const shoal::sim_state_t& message, std::string_view, CdrWriter& out) {
  const auto count = static_cast<std::size_t>(message.count);
  out.put_count(count);
  for (std::size_t i = 0; i < count; ++i) {
    put_header(out, message.utime, world_frame);
    out.put(message.vehicle[i]);
    out.put_array(std::span<const double>(message.position_m[i]));
    put_quaternion(out, std::span<const double>(message.orientation[i]).first<4>());
  }
  return true;
}

SHOAL_ROS2_CONVERTER(write_transforms, "tf2_msgs/msg/TFMessage", "/tf");

}  // namespace
}  // namespace bridges::ros2
