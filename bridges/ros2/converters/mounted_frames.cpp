// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <cmath>
#include <optional>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/sim_info_t.hpp"
#include "sim/base/math.hpp"
#include "sim/config/config_node.hpp"

namespace bridges::ros2 {
namespace {

/// Frame of a device in that of its vehicle, or of a body that may move in the vehicle.
struct MountedFrame {
  std::string parent, frame;
  sim::Pose pose;
};

/// Returns a list of three numbers; zeros when there is none.
sim::Vector3d three_numbers(const sim::ConfigNode& parent, std::string_view key) {
  sim::Vector3d numbers = sim::Vector3d::Zero();
  const sim::ConfigNode* list = parent.find(key);
  for (std::size_t i = 0; list != nullptr && i < 3 && i < list->items.size(); ++i) {
    const std::string& text = list->items[i].scalar;
    double number = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
    if (end.ec == std::errc() && std::isfinite(number)) numbers[static_cast<Eigen::Index>(i)] = number;
  }
  return numbers;
}

/// Returns the pose of a body or device in its parent, as written in a world.
sim::Pose pose_of(const sim::ConfigNode& node) {
  constexpr double rad_per_deg = M_PI / 180;
  return sim::make_pose(three_numbers(node, "position_m"), three_numbers(node, "rpy_deg") * rad_per_deg);
}

std::string text_at(const sim::ConfigNode& node, std::string_view key) {
  const sim::ConfigNode* value = node.find(key);
  return value != nullptr ? value->scalar : "";
}

const std::vector<sim::ConfigNode>& items_at(const sim::ConfigNode& node, std::string_view key) {
  static const std::vector<sim::ConfigNode> none;
  const sim::ConfigNode* list = node.find(key);
  return list != nullptr ? list->items : none;
}

/// Appends the frames of the devices of a vehicle.  The first body is the base, in which the vehicle frame is fixed.
void add_frames(const sim::ConfigNode& vehicle, std::vector<MountedFrame>& frames) {
  const std::string name = text_at(vehicle, "name");
  const sim::ConfigNode* model = vehicle.find("model");
  if (name.empty() || model == nullptr || items_at(*model, "bodies").empty()) return;
  const sim::ConfigNode& base = items_at(*model, "bodies").front();
  for (const sim::ConfigNode& device : items_at(*model, "devices")) {
    const std::string body = text_at(device, "body");
    const std::string channel = text_at(device, "channel");
    const std::string frame = frame_of(channel.empty() ? name + "." + text_at(device, "name") : channel);
    if (body.empty() || body == text_at(base, "name"))
      frames.push_back({name, frame, pose_of(base) * pose_of(device)});
    else
      frames.push_back({body_frame(name, body), frame, pose_of(device)});
  }
}

/// The frames of a resolved world.
std::vector<MountedFrame> frames_of(const std::string& world) {
  std::vector<MountedFrame> frames;
  sim::Diagnostics diagnostics;
  const sim::ConfigNode root = sim::parse_config_text(world, "sim.info", diagnostics);
  for (const sim::ConfigNode& vehicle : items_at(root, "vehicles")) add_frames(vehicle, frames);
  return frames;
}

/// Where the devices of the vehicles are mounted.
bool write_frames(const shoal::sim_info_t& message, std::string_view channel, CdrWriter& out) {
  // The same world is in every sim.info of a run.
  struct Parsed {
    std::string world;
    std::vector<MountedFrame> frames;
  };
  static thread_local std::optional<Parsed> last;
  if (channel != "sim.info") return false;
  if (!last || last->world != message.resolved_config)
    last = Parsed{message.resolved_config, frames_of(message.resolved_config)};
  out.put_count(last->frames.size());
  for (const MountedFrame& each : last->frames) {
    put_header(out, message.utime, each.parent);
    out.put(std::string_view(each.frame));
    const sim::Vector3d p = each.pose.translation();
    const Eigen::Quaterniond q(each.pose.linear());
    put_numbers(out, {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
  }
  return !last->frames.empty();
}

SHOAL_ROS2_CONVERTER(write_frames, "tf2_msgs/msg/TFMessage", "/tf_static");

}  // namespace
}  // namespace bridges::ros2
