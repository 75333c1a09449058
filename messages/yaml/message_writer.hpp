// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "shoal/message_schema.hpp"
#include "sim/config/config_node.hpp"

namespace shoal {

/// Returns whether a type has members in which NaN means "unchanged".
bool has_unchanged(std::string_view type);

/// Encodes a map `{member: value}` as a message of the type `type`, such as `shoal.pose_t`.  Missing members are 0,
/// empty or false, or NaN where NaN means "unchanged" (shoal.helm_command_t, station_command_t, waypoints_command_t),
/// which can also be written as `.nan`; a member that is the length of arrays follows from them.  A `byte` array may be
/// given as text.  Unknown types and members, values of another type or out of range, and lists of another length are
/// reported to `diagnostics` at their places, and the result is then empty.
std::vector<std::byte> encode_message(const MessageTypes& types, const std::string& type, const sim::ConfigNode& value,
                                      sim::Diagnostics& diagnostics);

/// Encodes a message of a type of Shoal; for sim::LoadOptions::encode_message.
std::vector<std::byte> encode_own_message(const std::string& type, const sim::ConfigNode& value,
                                          sim::Diagnostics& diagnostics);

}  // namespace shoal
