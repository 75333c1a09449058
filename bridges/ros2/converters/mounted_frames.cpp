// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "bridges/ros2/converters/scene_values.hpp"
#include "shoal/sim_info_t.hpp"
#include "shoal/sim_scene_t.hpp"

namespace bridges::ros2 {
namespace {

using Device = ConverterContext::Device;

Device device_of(const Json& device, std::string vehicle) {
  Device known;
  known.vehicle = std::move(vehicle);
  const Json* view = at(device, "field_of_view");
  if (view == nullptr) return known;
  known.is_camera = text_at(*view, "kind") == "frustum";
  known.range_min_m = static_cast<float>(number_at(*view, "range_min_m"));
  if (const double range_m = number_at(*view, "range_m"); range_m > 0) known.range_max_m = static_cast<float>(range_m);
  // A cone is given by half its opening.
  known.opening_rad = static_cast<float>(2 * number_at(*view, "half_angle_rad"));
  const auto axis = numbers_at<3>(*view, "axis");
  if (axis && sim::Vector3d(axis->data()).norm() > 0.5) known.axis = *axis;
  return known;
}

/// Appends a transform of tf2_msgs/TFMessage.
void put_transform(CdrWriter& out, std::int64_t utime, std::string_view parent, std::string_view frame,
                   const std::array<double, 7>& pose) {
  put_header(out, utime, parent);
  out.put(frame);
  out.put_array(std::span(pose).first(3));
  put_quaternion(out, std::span(pose).last<4>());
}

/// Returns the pose of a frame at the origin with x along an axis.
std::array<double, 7> along_x(const std::array<double, 3>& axis) {
  const sim::Quaterniond q = sim::rotation_between(sim::Vector3d::UnitX(), sim::Vector3d(axis.data()));
  return {0, 0, 0, q.w(), q.x(), q.y(), q.z()};
}

/// Appends all frames that do not move in their parents: devices in vehicles or moving bodies, optical and beam frames
/// in devices, odometry frames in the world.
bool put_frames(CdrWriter& out, std::int64_t utime, const ConverterContext& context) {
  std::size_t count = context.odometry_frames.size();
  for (const auto& [frame, device] : context.devices)
    count += (device.parent.empty() ? 0 : 1) + (device.is_camera || device.is_turned() ? 1 : 0);
  out.put_count(count);
  for (const auto& [frame, pose] : context.odometry_frames) put_transform(out, utime, world_frame, frame, pose);
  for (const auto& [frame, device] : context.devices) {
    if (!device.parent.empty()) put_transform(out, utime, device.parent, frame, device.pose);
    // x right, y down, z ahead are -y, -z, x of the sensor.
    if (device.is_camera)
      put_transform(out, utime, frame, frame + optical_ending, {0, 0, 0, 0.5, -0.5, 0.5, -0.5});
    else if (device.is_turned())
      put_transform(out, utime, frame, frame + beam_ending, along_x(device.axis));
  }
  return count > 0;
}

/// Where the devices of the vehicles are mounted, and where odometry starts.
bool write_frames(const shoal::sim_scene_t& message, ConverterContext& context, CdrWriter& out) {
  return put_frames(out, message.utime, context);
}

/// The same again: the frames of a run are in every part of its record.
bool write_frames_again(const shoal::sim_info_t& message, ConverterContext& context, CdrWriter& out) {
  return put_frames(out, message.utime, context);
}

SHOAL_ROS2_CONVERTER(write_frames, "tf2_msgs/msg/TFMessage", "/tf_static");
SHOAL_ROS2_CONVERTER(write_frames_again, "tf2_msgs/msg/TFMessage", "/tf_static");

}  // namespace

void read_devices(const Json& scene, ConverterContext& context) {
  context.devices.clear();
  context.odometry_frames.clear();
  for (const Json& vehicle : list_at(scene, "vehicles")) {
    const std::string name = text_at(vehicle, "name");
    const sim::Pose X_VB = pose_at(vehicle, "pose").inverse();
    for (const Json& each : list_at(vehicle, "devices")) {
      Device device = device_of(each, name);
      const std::int32_t body = integer_at(each, "body");
      const sim::Pose X_BS = pose_at(each, "pose");
      // The vehicle frame is fixed in its first body.  Odometry is of the vehicle, and is not mounted.
      const bool on_base = body == integer_at(vehicle, "body");
      device.pose = numbers_of(on_base ? X_VB * X_BS : X_BS);
      const auto moving = context.body_frames.find(body);
      if (at(each, "origin") != nullptr)
        context.odometry_frames.insert_or_assign(odometry_frame(name), numbers_of(pose_at(each, "origin")));
      else if (text_at(each, "type") == "odometry")
        device.parent = "";  // of an older version, which does not say where it starts
      else if (on_base)
        device.parent = name;
      else if (moving != context.body_frames.end())
        device.parent = moving->second;
      const Json& channels = list_at(each, "channels");
      const bool reports = !channels.empty() && channels.front().is_string();
      const std::string channel = reports ? channels.front().get<std::string>() : name + "." + text_at(each, "name");
      context.devices.insert_or_assign(frame_of(channel), std::move(device));
    }
  }
}

}  // namespace bridges::ros2
