// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/moos/vehicle_commands.hpp"

#include <algorithm>

#include "bridges/moos/vehicle_navigation.hpp"
#include "shoal/actuator_command_t.hpp"
#include "shoal/autopilot_command_t.hpp"
#include "shoal/helm_command_t.hpp"
#include "shoal/message_codec.hpp"

namespace bridges {

ChannelPayload helm_command(const std::string& channel, const HelmSetPoints& points, std::int64_t utime) {
  shoal::helm_command_t command{};
  command.utime = utime;
  command.speed_mps = points.speed_mps;
  command.heading_rad = yaw_rad_of(points.heading_deg);
  command.depth_m = points.depth_m;
  command.altitude_m = std::numeric_limits<double>::quiet_NaN();
  return {channel, shoal::encode(command)};
}

std::vector<ChannelPayload> thruster_commands(const ThrusterPair& pair, double port_percent, double starboard_percent,
                                              std::int64_t utime) {
  const auto command = [&](const std::string& channel, double percent) {
    shoal::actuator_command_t message{};
    message.utime = utime;
    message.value = std::clamp(percent, -100.0, 100.0) / 100 * pair.full_ahead;
    return ChannelPayload{channel, shoal::encode(message)};
  };
  std::vector<ChannelPayload> commands;
  if (!pair.autopilot.empty()) {
    shoal::autopilot_command_t off{};
    off.utime = utime;
    commands.push_back({pair.autopilot, shoal::encode(off)});
  }
  commands.push_back(command(pair.port, port_percent));
  commands.push_back(command(pair.starboard, starboard_percent));
  return commands;
}

}  // namespace bridges
