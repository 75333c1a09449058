// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/node/command_topics.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string_view>

#include "bridges/ros2/cdr.hpp"
#include "bridges/ros2/ros2_names.hpp"
#include "bridges/ros2/ros2_schema.hpp"
#include "shoal/actuator_command_t.hpp"
#include "shoal/joint_command_t.hpp"
#include "shoal/joint_servo_command_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/twist_command_t.hpp"
#include "shoal/waypoints_command_t.hpp"

namespace bridges::ros2 {
namespace {

using Payload = std::vector<std::byte>;

double finite(double value, const char* member) {
  if (!std::isfinite(value)) throw shoal::MessageError(std::string(member) + " must be finite");
  return value;
}

/// Skips std_msgs/Header: the stamp of a command is informative only, and its frame is that of the device.
void skip_header(CdrReader& in) {
  in.array<std::uint32_t, 2>();
  in.text();
}

Payload twist(CdrReader& in, std::int64_t utime) {
  const auto linear_mps = in.array<double, 3>();
  const auto angular_radps = in.array<double, 3>();
  shoal::twist_command_t command{};
  command.utime = utime;
  command.forward_mps = finite(linear_mps[0], "linear.x");
  command.turn_radps = finite(angular_radps[2], "angular.z");
  return shoal::encode(command);
}

Payload stamped_twist(CdrReader& in, std::int64_t utime) {
  skip_header(in);
  return twist(in, utime);
}

/// Positions of a path are in the world frame, z up; speed and depth set points of the water surface are Shoal's own.
Payload path(CdrReader& in, std::int64_t utime) {
  constexpr std::size_t min_pose_bytes = 8 + 5 + 7 * sizeof(double);  // stamp, empty frame, pose
  skip_header(in);
  shoal::waypoints_command_t command{};
  command.utime = utime;
  const std::size_t count = in.count(min_pose_bytes);
  command.n = static_cast<std::int32_t>(count);
  for (std::size_t i = 0; i < count; ++i) {
    skip_header(in);
    const auto position_m = in.array<double, 3>();
    in.array<double, 4>();
    command.x_m.push_back(finite(position_m[0], "position.x"));
    command.y_m.push_back(finite(position_m[1], "position.y"));
    command.depth_m.push_back(-finite(position_m[2], "position.z"));
  }
  command.speed_mps = std::numeric_limits<double>::quiet_NaN();
  return shoal::encode(command);
}

template <class Command, double Command::*member>
Payload number(CdrReader& in, std::int64_t utime) {
  Command command{};
  command.utime = utime;
  command.*member = finite(in.get<double>(), "data");
  return shoal::encode(command);
}

/// Topic in a standard type: of the vehicle, for its first device of the kind, or below that of each device.
struct StandardCommand {
  std::string_view lcm_type;
  const char* ros_type;
  const char* topic;
  bool of_vehicle;
  Payload (*convert)(CdrReader& in, std::int64_t utime);
};

constexpr const char* float64 = "std_msgs/msg/Float64";
constexpr std::array standard_commands{
    StandardCommand{"shoal.twist_command_t", "geometry_msgs/msg/Twist", "cmd_vel", true, twist},
    StandardCommand{"shoal.twist_command_t", "geometry_msgs/msg/TwistStamped", "cmd_vel_stamped", true, stamped_twist},
    StandardCommand{"shoal.waypoints_command_t", "nav_msgs/msg/Path", "path", false, path},
    StandardCommand{"shoal.actuator_command_t", float64, "cmd", false,
                    number<shoal::actuator_command_t, &shoal::actuator_command_t::value>},
    StandardCommand{"shoal.joint_command_t", float64, "cmd", false,
                    number<shoal::joint_command_t, &shoal::joint_command_t::velocity>},
    StandardCommand{"shoal.joint_servo_command_t", float64, "cmd", false,
                    number<shoal::joint_servo_command_t, &shoal::joint_servo_command_t::position>}};

/// Converts a message of the type that corresponds to an LCM type.  RTPS pads it to a multiple of four bytes.
Payload same_message(const shoal::MessageSchema& schema, std::span<const std::byte> cdr) {
  Payload payload;
  std::optional<std::string> error;
  for (std::size_t padding = 0; padding < 4 && padding <= cdr.size(); ++padding) {
    error = from_cdr(schema, cdr.first(cdr.size() - padding), payload);
    if (!error) return payload;
  }
  throw shoal::MessageError(*error);
}

/// Adds the topics for one type of command of a device.
void add_topics(const std::string& vehicle, const std::string& channel, std::string_view lcm_type,
                std::set<std::string_view>& of_vehicle, std::vector<CommandTopic>& topics) {
  const shoal::MessageSchema* schema = shoal::embedded_types().find(lcm_type);
  if (schema == nullptr) return;
  std::string_view short_type = lcm_type.substr(lcm_type.rfind('.') + 1);
  if (short_type.ends_with("_t")) short_type.remove_suffix(2);
  const std::string topic = topic_of(channel);
  topics.push_back({topic + "/" + std::string(short_type), type_name(schema->name), schema_text(*schema), channel,
                    [schema](std::span<const std::byte> cdr, std::int64_t) { return same_message(*schema, cdr); }});
  const std::string device = topic.substr(0, topic.rfind('/'));
  for (const StandardCommand& each : standard_commands) {
    if (each.lcm_type != lcm_type || (each.of_vehicle && !of_vehicle.insert(each.ros_type).second)) continue;
    topics.push_back({(each.of_vehicle ? topic_of(vehicle) : device) + "/" + each.topic, each.ros_type,
                      standard_schema_text(each.ros_type), channel,
                      [convert = each.convert](std::span<const std::byte> cdr, std::int64_t utime) {
                        CdrReader in(cdr);
                        return convert(in, utime);
                      }});
  }
}

}  // namespace

std::vector<CommandTopic> command_topics(const shoal::sim_vehicle_t& vehicle) {
  std::vector<CommandTopic> topics;
  std::set<std::string_view> of_vehicle;
  for (std::size_t i = 0; i < vehicle.command_channel.size(); ++i) {
    if (vehicle.command_channel[i].empty()) continue;
    std::string_view types = vehicle.command_types[i];
    while (!types.empty()) {
      const std::string_view type = types.substr(0, types.find(','));
      types.remove_prefix(std::min(types.size(), type.size() + 1));
      if (const std::size_t begin = type.find_first_not_of(' '); begin != std::string_view::npos)
        add_topics(vehicle.vehicle, vehicle.command_channel[i], type.substr(begin), of_vehicle, topics);
    }
  }
  return topics;
}

}  // namespace bridges::ros2
