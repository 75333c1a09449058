// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace sim {

/// Red, green and blue, sRGB-encoded as in files.
using Color = std::array<std::uint8_t, 3>;

/// Parses `#rrggbb`; returns empty for other texts.
std::optional<Color> parse_color(const std::string& text);

}  // namespace sim
