// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "sim/config/diagnostics.hpp"
#include "sim/config/message_text.hpp"

namespace sim {

/// Returns a name in quotes, printable and shortened, for messages.
inline std::string shown_name(const std::string& name) {
  return "'" + shortened(printable(name)) + "'";
}

/// Throws ConfigError when `count` exceeds the limit of the world.
inline void check_limit(const char* what, std::size_t count, int limit, const SourcePlace& place,
                        const std::string& who) {
  if (count > static_cast<std::size_t>(limit))
    throw_config_error(place, who,
                       "at most " + std::to_string(limit) + " " + what + " are allowed (limits of the world), got " +
                           std::to_string(count));
}

}  // namespace sim
