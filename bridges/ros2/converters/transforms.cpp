// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/sim_bodies_t.hpp"
#include "shoal/sim_state_t.hpp"

namespace bridges::ros2 {
namespace {

/// True poses of the bodies that can move, as transforms from the world frame.
bool write_bodies(const shoal::sim_bodies_t& message, ConverterContext& context, CdrWriter& out) {
  if (message.revision != context.scene_revision) return false;
  std::vector<std::pair<std::size_t, const std::string*>> named;
  for (std::size_t i = 0; i < static_cast<std::size_t>(message.count); ++i)
    if (const auto frame = context.body_frames.find(message.body[i]); frame != context.body_frames.end())
      named.emplace_back(i, &frame->second);
  out.put_count(named.size());
  for (const auto& [i, frame] : named) {
    put_header(out, message.utime, world_frame);
    out.put(std::string_view(*frame));
    out.put_array(std::span<const double>(message.position_m[i]));
    const std::vector<double> wxyz(message.orientation[i].begin(), message.orientation[i].end());
    put_quaternion(out, std::span<const double>(wxyz).first<4>());
  }
  return !named.empty();
}

SHOAL_ROS2_CONVERTER(write_bodies, "tf2_msgs/msg/TFMessage", "/tf");

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
