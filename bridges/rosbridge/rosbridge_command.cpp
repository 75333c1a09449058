// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/rosbridge/rosbridge_command.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "bridges/ros2/cdr.hpp"
#include "bridges/ros2/ros2_names.hpp"
#include "bridges/web/web_error.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/twist_command_t.hpp"

namespace bridges::rosbridge {
namespace {

constexpr std::string_view twist_command = "shoal.twist_command_t";

std::vector<std::string> split(std::string_view types) {
  std::vector<std::string> all;
  while (!types.empty()) {
    const std::size_t end = std::min(types.find(", "), types.size());
    all.emplace_back(types.substr(0, end));
    types.remove_prefix(std::min(end + 2, types.size()));
  }
  return all;
}

std::vector<std::byte> payload_of_twist(const RosType& type, const nlohmann::json& message) {
  const std::vector<std::byte> cdr = cdr_of_json(type, message);
  std::array<double, 6> twist{};  // linear, angular
  std::memcpy(twist.data(), cdr.data() + ros2::CdrWriter::header_bytes, sizeof twist);
  constexpr std::array names{"linear.x", "linear.y", "linear.z", "angular.x", "angular.y", "angular.z"};
  for (std::size_t i = 0; i < twist.size(); ++i) {
    if (!std::isfinite(twist[i])) throw WebError(std::string("'msg.") + names[i] + "': must be finite");
    if (i != 0 && i + 1 != twist.size() && twist[i] != 0)
      throw WebError(std::string("'msg.") + names[i] + "': must be 0, because the vehicle only drives ahead and turns");
  }
  shoal::twist_command_t command{};
  command.forward_mps = twist.front();
  command.turn_radps = twist.back();
  return shoal::encode(command);
}

}  // namespace

std::vector<CommandTopic> command_topics(const std::string& vehicle, const std::vector<std::string>& channels,
                                         const std::vector<std::string>& types, bool (*unchanged)(std::string_view)) {
  std::vector<CommandTopic> topics;
  std::string driven;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (channels[i].empty()) continue;
    CommandTopic topic{ros2::topic_of(channels[i]), {}, vehicle, channels[i]};
    for (const std::string& lcm_type : split(types[i])) {
      if (shoal::embedded_types().find(lcm_type) == nullptr) continue;
      topic.types.push_back({ros2::type_name(lcm_type), lcm_type, unchanged(lcm_type)});
      if (driven.empty() && lcm_type == twist_command) driven = channels[i];
    }
    if (!topic.types.empty()) topics.push_back(std::move(topic));
  }
  if (!driven.empty())
    topics.push_back(
        {ros2::topic_of(vehicle) + "/cmd_vel", {{twist_type, std::string(twist_command)}}, vehicle, driven});
  return topics;
}

const CommandTopic::Type& command_type_of(const CommandTopic& topic, std::string_view name) {
  if (name.empty()) return topic.types.front();
  std::string known;
  for (const CommandTopic::Type& each : topic.types) {
    if (short_name(each.name) == short_name(name)) return each;
    known += (known.empty() ? "" : ", ") + each.name;
  }
  throw WebError(topic.topic + ": its type must be " + known + ", got " + std::string(name));
}

std::vector<std::byte> command_payload(const RosType& type, const CommandTopic::Type& command,
                                       const nlohmann::json& message) {
  if (command.name == twist_type) return payload_of_twist(type, message);
  const shoal::MessageSchema* const schema = shoal::embedded_types().find(command.lcm_type);
  if (schema == nullptr) throw WebError("there is no type " + command.lcm_type);
  const double missing = command.unchanged ? std::numeric_limits<double>::quiet_NaN() : 0;
  std::vector<std::byte> payload;
  auto error = ros2::from_cdr(*schema, cdr_of_json(type, message, missing), payload);
  if (!error && !command.unchanged) error = shoal::validate(*schema, payload, shoal::Finite::required);
  if (error) throw WebError("'msg': " + *error);
  return payload;
}

}  // namespace bridges::rosbridge
