// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "shoal/message_schema.hpp"

namespace bridges::ros2 {

/// Line between the definitions of a type and the types that it uses.
inline const std::string schema_separator = std::string(80, '=') + "\n";
/// Member of a type that has none, for ROS 2 has no empty types.
inline constexpr const char* only_member = "structure_needs_at_least_one_member";

/// Schema of an LCM type as `ros2msg` text: its definition, then those of all types that it uses, in the order of their
/// first use.  Arrays with several dimensions become one, row by row; of fixed size if all dimensions are.
std::string schema_text(const shoal::MessageSchema& schema);

}  // namespace bridges::ros2
