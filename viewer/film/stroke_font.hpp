// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace viewer {

/// Returns the strokes of a character of ASCII, drawn by lines: `082248 0242` are two lines through the points
/// (0, 8), (2, 2), (4, 8) and (0, 2), (4, 2).  x is 0 to 4, y upwards: 2 is the base line, 6 the height of small
/// letters, 8 that of capitals.  Other characters have the strokes of `?`.
std::string_view strokes_of(char character);

/// Distance between characters, in the same unit.
inline constexpr float character_width = 5.8F;

}  // namespace viewer
