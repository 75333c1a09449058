// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "sim/bus/bus.hpp"

namespace sim {

// Messages begin with 8 bytes of fingerprint, and Shoal's go on with `int64_t utime`, big-endian.

/// What stands where a message has its utime; nothing when it is too short.
std::optional<std::int64_t> utime_of(std::span<const std::byte> payload);
/// Puts a utime there.  The message must be long enough.
void set_utime(Bytes& payload, std::int64_t utime);

}  // namespace sim
