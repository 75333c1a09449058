// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/ctd_t.hpp"
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

}  // namespace
}  // namespace bridges::ros2
