// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "sim/config/diagnostics.hpp"
#include "sim/config/message_text.hpp"

namespace sim {

/// A name for a message, in quotes.
inline std::string shown_name(const std::string& name) {
  return "'" + shortened(printable(name)) + "'";
}

/// Throws ConfigError when there would be more than the world allows.
inline void check_limit(const char* what, std::size_t count, int limit, const SourcePlace& place,
                        const std::string& who) {
  if (count > static_cast<std::size_t>(limit))
    throw_config_error(place, who,
                       "at most " + std::to_string(limit) + " " + what + " are allowed (limits of the world), got " +
                           std::to_string(count));
}

}  // namespace sim
