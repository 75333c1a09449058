// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

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
  const bool fix = message.gps_lock > 0;
  if (fix)
    put_numbers(out, {horizontal, 0, 0, 0, horizontal, 0, 0, 0, vertical});
  else
    // NavSatFix has zeros for an unknown covariance, together with its type.
    out.put_array(std::span<const double>(unknown_3x3));
  out.put(fix ? covariance_diagonal : covariance_unknown);
  return true;
}

/// Velocity over ground, of the course from north; only with a fix.  Its axes are east and north at the vehicle, which
/// differ from those of the world by the convergence of the meridians: 0.47 degrees 30 km east at 60 degrees latitude.
bool write_ground_velocity(const shoal::gps_data_t& message, std::string_view, CdrWriter& out) {
  if (message.gps_lock <= 0) return false;
  put_header(out, message.utime, world_frame);
  put_numbers(out, {message.speed * std::sin(message.heading), message.speed * std::cos(message.heading), 0});
  put_numbers(out, {0, 0, 0});
  put_unknown_6x6(out);
  return true;
}

SHOAL_ROS2_CONVERTER(write_fix, "sensor_msgs/msg/NavSatFix", "fix");
SHOAL_ROS2_CONVERTER(write_ground_velocity, "geometry_msgs/msg/TwistWithCovarianceStamped", "velocity");

}  // namespace
}  // namespace bridges::ros2
