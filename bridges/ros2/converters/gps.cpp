// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/gps_data_t.hpp"

namespace bridges::ros2 {
namespace {

/// sensor_msgs/NavSatStatus of gps_lock: none, autonomous, differential.
std::int8_t status_of(std::int32_t gps_lock) {
  constexpr std::int8_t no_fix = -1, fix = 0, differential = 2;
  return gps_lock <= 0 ? no_fix : gps_lock == 1 ? fix : differential;
}

bool write_fix(const shoal::gps_data_t& message, std::string_view channel, CdrWriter& out) {
  constexpr std::uint16_t service_gps = 1;
  constexpr std::uint8_t covariance_unknown = 0, covariance_diagonal = 2;
  put_header(out, message.utime, frame_of(channel));
  out.put(status_of(message.gps_lock));
  out.put(service_gps);
  out.put(message.latitude);
  out.put(message.longitude);
  out.put(message.elev);
  const double horizontal = message.horizontal_accuracy * message.horizontal_accuracy;
  const double vertical = message.vertical_accuracy * message.vertical_accuracy;
  put_numbers(out, {horizontal, 0, 0, 0, horizontal, 0, 0, 0, vertical});
  out.put(message.gps_lock > 0 ? covariance_diagonal : covariance_unknown);
  return true;
}

SHOAL_ROS2_CONVERTER(write_fix, "sensor_msgs/msg/NavSatFix", "fix");

}  // namespace
}  // namespace bridges::ros2
