// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "shoal/sim_vehicle_t.hpp"

namespace bridges::ros2 {

/// Topic of ROS 2 on which a device of a vehicle takes commands.
struct CommandTopic {
  std::string name;     ///< such as `/rover1/cmd_vel`
  std::string type;     ///< such as `geometry_msgs/msg/Twist`
  std::string schema;   ///< of the type, as `ros2msg` text
  std::string channel;  ///< LCM channel of the device, such as `rover1.drive.cmd`
  /// Converts a message, padded by up to three bytes, into the LCM payload; `utime` is its stamp where the message has
  /// none of its own.  Throws shoal::MessageError for bytes that are not of the type, and for values that are not
  /// finite where the type permits only finite ones.
  std::function<std::vector<std::byte>(std::span<const std::byte> cdr, std::int64_t utime)> convert;
};

/// Returns the topics of all devices of a vehicle that take commands.  Each type of command of a device has the topic
/// `/VEHICLE/DEVICE/cmd/TYPE` with the message itself (`twist_command` of `shoal.twist_command_t`).  In standard types
/// there are besides: `/VEHICLE/cmd_vel` and `cmd_vel_stamped` (Twist, TwistStamped: linear.x in m/s, angular.z in
/// rad/s) for the first device that drives, `/VEHICLE/DEVICE/path` (Path in the frame `world`) for routes, and
/// `/VEHICLE/DEVICE/cmd` (Float64) for single actuators, velocities of joint motors and positions of joint servos.
std::vector<CommandTopic> command_topics(const shoal::sim_vehicle_t& vehicle);

}  // namespace bridges::ros2
