// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "sim/bus/bus.hpp"

namespace sim {

// Messages start with 8 bytes of fingerprint, followed in Shoal's types by `int64_t utime`, big-endian.

/// Returns the value at the position of utime in a message; none when the message is too short.
std::optional<std::int64_t> utime_of(std::span<const std::byte> payload);
/// Writes the utime of a message.  The message must be long enough.
void set_utime(Bytes& payload, std::int64_t utime);

}  // namespace sim
