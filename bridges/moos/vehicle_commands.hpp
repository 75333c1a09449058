// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace bridges {

/// Encoded message for a channel.
struct ChannelPayload {
  std::string channel;
  std::vector<std::byte> payload;
};

/// Set points of a helm in the conventions of marine autonomy; NaN: none.
struct HelmSetPoints {
  double heading_deg = std::numeric_limits<double>::quiet_NaN();  ///< clockwise from north
  double speed_mps = std::numeric_limits<double>::quiet_NaN();
  double depth_m = std::numeric_limits<double>::quiet_NaN();
};

/// Two propellers beside each other, whose commands are proportional to the shaft speed.
struct ThrusterPair {
  std::string port, starboard;  ///< channels of their commands; empty: there are none
  double full_ahead = 1;        ///< command at 100 percent
  std::string autopilot;        ///< channel of an autopilot that would set them itself; empty: there is none
};

/// Returns the command to an autopilot.
ChannelPayload helm_command(const std::string& channel, const HelmSetPoints& points, std::int64_t utime);
/// Returns the commands to both propellers, after that of their autopilot to leave them alone, in percent from -100 to
/// 100.
std::vector<ChannelPayload> thruster_commands(const ThrusterPair& pair, double port_percent, double starboard_percent,
                                              std::int64_t utime);

}  // namespace bridges
