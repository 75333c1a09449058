// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/joint_state_t.hpp"

namespace bridges::ros2 {
namespace {

bool write_joints(const shoal::joint_state_t& message, std::string_view channel, CdrWriter& out) {
  put_header(out, message.utime, frame_of(channel));
  out.put_count(message.joint_name.size());
  for (const std::string& name : message.joint_name) out.put(std::string_view(name));
  for (const auto* values : {&message.joint_position, &message.joint_velocity, &message.joint_effort})
    out.put_sequence(std::span<const double>(std::vector<double>(values->begin(), values->end())));
  return true;
}

SHOAL_ROS2_CONVERTER(write_joints, "sensor_msgs/msg/JointState", "joint_states");

}  // namespace
}  // namespace bridges::ros2
