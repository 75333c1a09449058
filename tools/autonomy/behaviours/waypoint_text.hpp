// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tools/autonomy/filters/pose2.hpp"

namespace autonomy {

/// Waypoints as on the command line: `10,5;20,-3`, east and north in m.  Throws std::invalid_argument with
/// the place that is wrong.
std::vector<Vector2d> parse_waypoints(const std::string& text);

/// A start pose: `x,y,yaw_deg`.
Pose2 parse_start(const std::string& text);

/// So many numbers between commas; `form` is what the error says they should look like.
std::vector<double> parse_numbers(std::string_view text, std::size_t count, const char* form);

}  // namespace autonomy
