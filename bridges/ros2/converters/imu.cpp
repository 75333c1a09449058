// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/compass_t.hpp"
#include "shoal/imu_t.hpp"
#include "shoal/ins_t.hpp"

namespace bridges::ros2 {
namespace {

/// An IMU has no orientation: REP 145 marks this by -1 in its covariance.
bool write_imu(const shoal::imu_t& message, std::string_view channel, CdrWriter& out) {
  put_header(out, message.utime, frame_of(channel));
  put_numbers(out, {0, 0, 0, 1});
  put_numbers(out, {-1, 0, 0, 0, 0, 0, 0, 0, 0});
  put_numbers(out, message.angular_velocity_radps);
  out.put_array(std::span<const double>(unknown_3x3));
  put_numbers(out, message.linear_acceleration_mps2);
  out.put_array(std::span<const double>(unknown_3x3));
  return true;
}

bool write_ins(const shoal::ins_t& message, std::string_view channel, CdrWriter& out) {
  put_header(out, message.utime, frame_of(channel));
  put_quaternion(out, message.quat);
  out.put_array(std::span<const double>(unknown_3x3));
  put_numbers(out, message.gyro);
  out.put_array(std::span<const double>(unknown_3x3));
  put_numbers(out, message.accel);
  out.put_array(std::span<const double>(unknown_3x3));
  return true;
}

SHOAL_ROS2_CONVERTER(write_imu, "sensor_msgs/msg/Imu", "imu");
SHOAL_ROS2_CONVERTER(write_ins, "sensor_msgs/msg/Imu", "imu");

bool write_field(const shoal::compass_t& message, std::string_view channel, CdrWriter& out) {
  constexpr double tesla_per_uT = 1e-6;
  put_header(out, message.utime, frame_of(channel));
  for (const double field_uT : message.field_uT) out.put(field_uT * tesla_per_uT);
  out.put_array(std::span<const double>(unknown_3x3));
  return true;
}

SHOAL_ROS2_CONVERTER(write_field, "sensor_msgs/msg/MagneticField", "field");

}  // namespace
}  // namespace bridges::ros2
