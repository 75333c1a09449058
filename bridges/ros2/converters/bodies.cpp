// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>

#include "bridges/ros2/converter.hpp"
#include "bridges/ros2/converters/common_parts.hpp"
#include "shoal/sim_bodies_t.hpp"
#include "shoal/sim_scene_t.hpp"

namespace bridges::ros2 {
namespace {

using Json = nlohmann::json;

std::string scene_text(const Json& item, const char* key) {
  const auto value = item.find(key);
  return value != item.end() && value->is_string() ? value->get<std::string>() : "";
}

/// Remembers the frames of the bodies of a scene; it gives no message itself.
bool read_scene(const shoal::sim_scene_t& message, ConverterContext& context, CdrWriter&) {
  context.body_frames.clear();
  context.scene_revision = message.revision;
  const Json scene = Json::parse(message.scene, nullptr, false);
  if (!scene.is_object() || !scene.contains("bodies") || !scene["bodies"].is_array()) return false;
  for (const Json& body : scene["bodies"]) {
    if (!body.is_object() || !body.contains("id") || !body["id"].is_number_integer()) continue;
    const std::string owner = scene_text(body, "owner");
    std::string name = scene_text(body, "name");
    if (name.starts_with(owner + "/")) name.erase(0, owner.size() + 1);
    context.body_frames.insert_or_assign(body["id"].get<std::int32_t>(), body_frame(owner, name));
  }
  return false;
}

/// True poses of the bodies that can move, as transforms from the world frame.
bool write_bodies(const shoal::sim_bodies_t& message, ConverterContext& context, CdrWriter& out) {
  if (message.revision != context.scene_revision) return false;
  std::vector<std::pair<std::size_t, const std::string*>> named;
  for (std::size_t i = 0; i < static_cast<std::size_t>(message.count); ++i)
    if (const auto frame = context.body_frames.find(message.body[i]); frame != context.body_frames.end())
      named.emplace_back(i, &frame->second);
  out.put_count(named.size());
  for (const auto& [i, frame] : named) {
    put_header(out, message.utime, world_frame);
    out.put(std::string_view(*frame));
    out.put_array(std::span<const double>(message.position_m[i]));
    const std::vector<double> wxyz(message.orientation[i].begin(), message.orientation[i].end());
    put_quaternion(out, std::span<const double>(wxyz).first<4>());
  }
  return !named.empty();
}

SHOAL_ROS2_CONVERTER(read_scene, "tf2_msgs/msg/TFMessage", "/tf");
SHOAL_ROS2_CONVERTER(write_bodies, "tf2_msgs/msg/TFMessage", "/tf");

}  // namespace
}  // namespace bridges::ros2
