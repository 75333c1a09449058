// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/rosbridge/ros_json.hpp"
#include "bridges/rosbridge/rosapi.hpp"

namespace bridges::rosbridge {

/// Type of the velocity of a vehicle, of which a `shoal.twist_command_t` is made.
inline constexpr const char* twist_type = "geometry_msgs/msg/Twist";

/// Returns the topics on which a vehicle takes commands: `/VEHICLE/DEVICE/cmd` of each device with the types of its
/// commands, and `/VEHICLE/cmd_vel` (twist_type) for the first device that takes a `shoal.twist_command_t`.
/// `types`: of each device, comma separated as in `sim.vehicle`.
std::vector<CommandTopic> command_topics(const std::string& vehicle, const std::vector<std::string>& channels,
                                         const std::vector<std::string>& types, bool (*unchanged)(std::string_view));

/// Returns the type of a topic with this name, with or without `msg`; empty: the first.  Throws WebError if it has
/// none.
const CommandTopic::Type& command_type_of(const CommandTopic& topic, std::string_view name);

/// Returns the command that a client's message stands for, as an LCM payload.  Of a Twist, forward_mps is `linear.x`
/// and turn_radps `angular.z` (REP 103); the others must be 0.  Throws WebError with the rule.
std::vector<std::byte> command_payload(const RosType& type, const CommandTopic::Type& command,
                                       const nlohmann::json& message);

}  // namespace bridges::rosbridge
