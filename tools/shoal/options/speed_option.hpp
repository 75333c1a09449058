// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace tools {

/// Parses the value of --speed: `max` (0) or a multiple of real time; std::nullopt if it is empty.  Throws
/// CLI::ValidationError.
std::optional<double> parse_speed(const std::string& text);

}  // namespace tools
