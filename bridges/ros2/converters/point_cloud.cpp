// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converters/point_cloud.hpp"

#include <cmath>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/multibeam_t.hpp"
#include "shoal/point_cloud_t.hpp"

namespace bridges::ros2 {
namespace {

constexpr std::array lidar_columns{PointColumn{"x", 0, point_float32},      PointColumn{"y", 4, point_float32},
                                   PointColumn{"z", 8, point_float32},      PointColumn{"intensity", 12, point_float32},
                                   PointColumn{"time_us", 16, point_int32}, PointColumn{"ring", 20, point_uint16}};
constexpr std::uint32_t lidar_point_bytes = 22;

bool write_points(const shoal::point_cloud_t& message, std::string_view channel, CdrWriter& out) {
  put_header(out, message.utime, frame_of(channel));
  const auto count = static_cast<std::size_t>(message.count);
  std::byte* point = put_cloud(out, lidar_columns, lidar_point_bytes, count);
  for (std::size_t i = 0; i < count; ++i, point += lidar_point_bytes) {
    store(point, 0, message.x_m[i]);
    store(point, 4, message.y_m[i]);
    store(point, 8, message.z_m[i]);
    store(point, 12, message.intensities[i]);
    store(point, 16, message.time_offsets_us[i]);
    store(point, 20, static_cast<std::uint16_t>(message.rings[i]));
  }
  out.put(true);  // every point is valid
  return true;
}

constexpr std::array beam_columns{PointColumn{"x", 0, point_float32}, PointColumn{"y", 4, point_float32},
                                  PointColumn{"z", 8, point_float32}, PointColumn{"intensity", 12, point_float32}};
constexpr std::uint32_t beam_point_bytes = 16;

/// The echoes of a multibeam sonar, in the yz-plane of the sensor: angles are from -z towards +y.
bool write_beams(const shoal::multibeam_t& message, std::string_view channel, CdrWriter& out) {
  put_header(out, message.utime, frame_of(channel));
  std::size_t echoes = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(message.count); ++i) echoes += message.valid[i] != 0;
  std::byte* point = put_cloud(out, beam_columns, beam_point_bytes, echoes);
  for (std::size_t i = 0; i < static_cast<std::size_t>(message.count); ++i) {
    if (message.valid[i] == 0) continue;
    store(point, 0, 0.0f);
    store(point, 4, message.ranges_m[i] * std::sin(message.angles_rad[i]));
    store(point, 8, -message.ranges_m[i] * std::cos(message.angles_rad[i]));
    store(point, 12, message.strengths_dB[i]);
    point += beam_point_bytes;
  }
  out.put(true);
  return true;
}

SHOAL_ROS2_CONVERTER(write_points, "sensor_msgs/msg/PointCloud2", "points");
SHOAL_ROS2_CONVERTER(write_beams, "sensor_msgs/msg/PointCloud2", "points");

}  // namespace
}  // namespace bridges::ros2
