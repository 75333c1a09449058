// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

// What other nodes of ROS 2 need to know of the types of messages: their hashes, by which they compare them, and the
// definitions of those that are Shoal's own.

namespace bridges::ros2 {

/// Hash of a type and of those that it uses, by which ROS 2 compares types since Iron: RIHS01_ and the 64 hexadecimal
/// digits of the SHA-256 of a description of all members, in JSON (REP 2016).  Constants, comments and defaults are not
/// part of it.
///
/// `type`: full name, such as `sensor_msgs/msg/Imu`.
/// `schema`: as schema_text() and standard_schema_text() return it.
std::string type_hash(std::string_view type, std::string_view schema);

/// Writes `folder`/shoal_interfaces, a package of ROS 2 with Shoal's message types (DVL, USBL, modem, commands, ...),
/// for `colcon build`: package.xml, CMakeLists.txt, and a file `.msg` for each type, with the comments of its `.lcm`
/// file.  A message of such a type has the CDR of to_cdr().
///
/// Throws BusError if a file cannot be written, or if the package exists: it may have changes of a user.
void write_message_package(const std::string& folder);

}  // namespace bridges::ros2
