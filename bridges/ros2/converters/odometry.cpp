// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/estimate_t.hpp"
#include "shoal/odometry_t.hpp"
#include "shoal/pose_t.hpp"

namespace bridges::ros2 {
namespace {

/// Frame whose pose a channel tells: of the vehicle on that of a device or an estimate, of its own otherwise, such as a
/// goal.
std::string posed_frame(std::string_view channel, const ConverterContext& context) {
  const bool is_of_vehicle = channel.ends_with(".estimate") || !context.device_of(channel).vehicle.empty();
  return is_of_vehicle ? vehicle_frame(channel, context) : frame_of(channel);
}

/// Velocities of nav_msgs/Odometry are in the axes of the moving frame, those of pose_t in the world frame.
bool write_pose(const shoal::pose_t& message, std::string_view channel, ConverterContext& context, CdrWriter& out) {
  const double* q = message.orientation;
  Eigen::Quaterniond turn(q[0], q[1], q[2], q[3]);
  // Programs round, and some leave zeros, which name no direction.
  if (!std::isfinite(turn.norm()) || turn.norm() < 1e-6) return false;
  turn.normalize();
  const double unit[4] = {turn.w(), turn.x(), turn.y(), turn.z()};
  put_header(out, message.utime, world_frame);
  out.put(std::string_view(posed_frame(channel, context)));
  put_numbers(out, message.pos);
  put_quaternion(out, unit);
  put_unknown_6x6(out);
  const Eigen::Quaterniond to_body = turn.conjugate();
  const Eigen::Vector3d v = to_body * Eigen::Vector3d(message.vel);
  const Eigen::Vector3d w = to_body * Eigen::Vector3d(message.rotation_rate);
  put_numbers(out, {v.x(), v.y(), v.z(), w.x(), w.y(), w.z()});
  put_unknown_6x6(out);
  return true;
}

/// Dead reckoning from the pose in which the vehicle starts.
bool write_wheel_odometry(const shoal::odometry_t& message, std::string_view channel, ConverterContext& context,
                          CdrWriter& out) {
  const std::string vehicle = vehicle_frame(channel, context);
  put_header(out, message.utime, odometry_frame(vehicle));
  out.put(std::string_view(vehicle));
  put_numbers(out, {message.x_m, message.y_m, 0});
  put_numbers(out, {0, 0, std::sin(message.theta_rad / 2), std::cos(message.theta_rad / 2)});
  put_unknown_6x6(out);
  put_numbers(out, {message.forward_mps, 0, 0, 0, 0, message.turn_radps});
  put_unknown_6x6(out);
  return true;
}

SHOAL_ROS2_CONVERTER(write_pose, "nav_msgs/msg/Odometry", "odometry");
SHOAL_ROS2_CONVERTER(write_wheel_odometry, "nav_msgs/msg/Odometry", "odometry");

/// Only the yaw of the rotation is estimated; its variance is not in the message.
bool write_estimate(const shoal::estimate_t& message, std::string_view, CdrWriter& out) {
  put_header(out, message.utime, world_frame);
  put_numbers(out, message.position_m);
  put_numbers(out, {0, 0, std::sin(message.yaw_rad / 2), std::cos(message.yaw_rad / 2)});
  put_position_covariance(out, message.covariance_m2);
  return true;
}

SHOAL_ROS2_CONVERTER(write_estimate, "geometry_msgs/msg/PoseWithCovarianceStamped", "pose");

}  // namespace
}  // namespace bridges::ros2
