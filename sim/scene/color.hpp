// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace sim {

/// Red, green, blue as files have them (sRGB).
using Color = std::array<std::uint8_t, 3>;

/// `#rrggbb`; empty when the text looks different.
std::optional<Color> parse_color(const std::string& text);

}  // namespace sim
