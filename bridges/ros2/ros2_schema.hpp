// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "shoal/message_schema.hpp"

namespace bridges::ros2 {

/// Line between the definitions of a type and the types that it uses.
inline const std::string schema_separator = std::string(80, '=') + "\n";
/// Member of a type that has none, for ROS 2 has no empty types.
inline constexpr const char* only_member = "structure_needs_at_least_one_member";

/// Schema of an LCM type as `ros2msg` text: its definition, then those of all types that it uses, in the order of their
/// first use.  Arrays with several dimensions become one, row by row; of fixed size if all dimensions are.
std::string schema_text(const shoal::MessageSchema& schema);

/// Schema of a standard type of ROS 2, such as `sensor_msgs/msg/Imu`, as `ros2msg` text with the types that it uses.
/// Throws std::out_of_range for a type that is not in the table.
std::string standard_schema_text(std::string_view type);

}  // namespace bridges::ros2
