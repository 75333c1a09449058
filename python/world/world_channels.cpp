// SPDX-License-Identifier: BSD-3-Clause
#include "python/world/world_channels.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "sim/config/message_text.hpp"

namespace python {

WorldChannels::WorldChannels(const sim::World& world) {
  const sim::WorldConfig& config = world.config();
  for (const auto& vehicle : world.vehicles())
    for (const sim::MountedDevice* device : vehicle->devices()) {
      const sim::DeviceType& type = *device->config().device_type;
      if (type.takes_commands()) received[device->command_channel()] = type.command_messages;
      if (!type.reports()) continue;
      published.insert(device->report_channel());
      const std::string truth =
          sim::device_channel(config.channels, vehicle->name(), device->config(), sim::ChannelKind::truth);
      if (device->config().truth)
        published.insert(truth);
      else
        silent[truth] = device->full_name();
    }
  for (const sim::EventConfig& event : config.events) {
    if (event.when.kind == sim::Condition::Kind::message) received.try_emplace(event.when.subject);
    std::set<std::string> channels;
    for (const sim::ActionEntry& entry : event.actions)
      if (entry.action) entry.action->add_channels(channels);
    published.insert(channels.begin(), channels.end());
  }
  for (const sim::MetricConfig& metric : config.metrics)
    if (metric.params && !metric.params->channel.empty()) received.try_emplace(metric.params->channel);
}

std::string WorldChannels::meant(const std::string& channel, bool received_only) const {
  std::vector<std::string> names;
  for (const auto& [name, types] : received) names.push_back(name);
  if (!received_only) names.insert(names.end(), published.begin(), published.end());
  if (std::string hint = sim::did_you_mean(channel, names); !hint.empty()) return hint;
  const auto part = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
    return name.starts_with(channel + ".") || name.ends_with("." + channel);
  });
  return part == names.end() || channel.empty() ? "" : "; did you mean '" + *part + "'?";
}

bool may_have_nan(const std::string& type) {
  constexpr std::array<std::string_view, 7> types{
      "shoal.helm_command_t",          "shoal.joint_frames_t",    "shoal.joint_settings_t",   "shoal.motion_command_t",
      "shoal.pan_tilt_zoom_command_t", "shoal.station_command_t", "shoal.waypoints_command_t"};
  return std::find(types.begin(), types.end(), type) != types.end();
}

void LastMessages::publish(std::string_view channel, std::span<const std::byte> payload, sim::Time at) {
  auto found = last_.find(channel);
  if (found == last_.end()) found = last_.emplace(channel, sim::Bytes()).first;
  found->second.assign(payload.begin(), payload.end());
  bus_.publish(channel, payload, at);
}

const sim::Bytes* LastMessages::find(std::string_view channel) const {
  const auto found = last_.find(channel);
  return found == last_.end() ? nullptr : &found->second;
}

}  // namespace python
