// SPDX-License-Identifier: BSD-3-Clause
#include "sim/scene/color.hpp"

#include <charconv>

namespace sim {

std::optional<Color> parse_color(const std::string& text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  Color color;
  for (std::size_t i = 0; i < 3; ++i) {
    const char* begin = text.data() + 1 + 2 * i;
    const auto [end, error] = std::from_chars(begin, begin + 2, color[i], 16);
    if (error != std::errc{} || end != begin + 2) return std::nullopt;
  }
  return color;
}

}  // namespace sim
