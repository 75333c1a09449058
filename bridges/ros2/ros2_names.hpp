// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "shoal/message_schema.hpp"

namespace bridges::ros2 {

/// Name of the ROS 2 type of an LCM type, without `msg`: `shoal.gps_data_t` is `shoal_interfaces/GpsData`.
std::string short_type_name(std::string_view lcm_type);
/// Full name of the ROS 2 type of an LCM type: `shoal.gps_data_t` is `shoal_interfaces/msg/GpsData`.
std::string type_name(std::string_view lcm_type);
/// Name of a ROS 2 type in DDS: `sensor_msgs/msg/Imu` is `sensor_msgs::msg::dds_::Imu_`.
std::string dds_type_name(std::string_view ros_type);
/// Names of the members of a type in ROS 2, in order: lower case, with digits and single underscores, each once.
std::vector<std::string> field_names(const shoal::MessageSchema& schema);
/// Topic of a channel: `rover1.lidar` is `/rover1/lidar`.  Characters that ROS 2 does not allow become underscores.
std::string topic_of(std::string_view channel);
/// Coordinate frame of the reports on a channel: `rover1/lidar` of `rover1.lidar` and of `rover1.lidar.truth`.
std::string frame_of(std::string_view channel);

}  // namespace bridges::ros2
