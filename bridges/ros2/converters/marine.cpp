// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/ctd_t.hpp"
#include "shoal/dvl_t.hpp"
#include "shoal/pressure_t.hpp"

namespace bridges::ros2 {
namespace {

/// sensor_msgs/FluidPressure and sensor_msgs/Temperature have equal members; the variance is unknown.
void put_scalar(CdrWriter& out, std::int64_t utime, std::string_view channel, double value) {
  put_header(out, utime, frame_of(channel));
  put_numbers(out, {value, 0});
}

template <class Message>
bool put_pressure(const Message& message, std::string_view channel, CdrWriter& out) {
  put_scalar(out, message.utime, channel, message.pressure_Pa);
  return true;
}

template <class Message>
bool put_temperature(const Message& message, std::string_view channel, CdrWriter& out) {
  put_scalar(out, message.utime, channel, message.temperature_C);
  return true;
}

constexpr auto write_pressure = put_pressure<shoal::pressure_t>;
constexpr auto write_ctd_pressure = put_pressure<shoal::ctd_t>;
constexpr auto write_temperature = put_temperature<shoal::pressure_t>;
constexpr auto write_ctd_temperature = put_temperature<shoal::ctd_t>;

SHOAL_ROS2_CONVERTER(write_pressure, "sensor_msgs/msg/FluidPressure", "pressure");
SHOAL_ROS2_CONVERTER(write_temperature, "sensor_msgs/msg/Temperature", "temperature");
SHOAL_ROS2_CONVERTER(write_ctd_pressure, "sensor_msgs/msg/FluidPressure", "pressure");
SHOAL_ROS2_CONVERTER(write_ctd_temperature, "sensor_msgs/msg/Temperature", "temperature");

/// Velocity over the bottom in the axes of the sensor; no message without bottom lock.
bool write_velocity(const shoal::dvl_t& message, std::string_view channel, CdrWriter& out) {
  if (message.bottom_lock == 0) return false;
  put_header(out, message.utime, frame_of(channel));
  put_numbers(out, message.velocity_mps);
  put_numbers(out, {0, 0, 0});
  const double variance = message.fom_mps * message.fom_mps;
  put_position_covariance(out, std::array<double, 9>{variance, 0, 0, 0, variance, 0, 0, 0, variance});
  return true;
}

SHOAL_ROS2_CONVERTER(write_velocity, "geometry_msgs/msg/TwistWithCovarianceStamped", "velocity");

}  // namespace
}  // namespace bridges::ros2
