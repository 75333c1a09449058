// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace bridges::ros2 {

/// Schema of a standard type of ROS 2, such as `sensor_msgs/msg/Imu`, as `ros2msg` text with the types that it uses.
/// Throws std::out_of_range for a type that is not in the table.
std::string standard_schema_text(std::string_view type);

}  // namespace bridges::ros2
