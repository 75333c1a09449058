// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace sim {

/// Colors of vehicles, 0xrrggbb, which differ for most color-blind people too: those of Okabe and Ito (2008) without
/// yellow, which is that of estimates, then brown and violet.  The same table is in viewer/page/palette.js and
/// python/shoal/plots.py.
inline constexpr std::array<std::uint32_t, 8> vehicle_colors{0x56b4e9, 0xe69f00, 0x009e73, 0xd55e00,
                                                             0xcc79a7, 0x0072b2, 0xa6761d, 0x8c6bb1};
inline constexpr std::uint32_t estimate_color = 0xf0e442;

/// Returns the color of a vehicle by its number.
constexpr std::uint32_t vehicle_color(int number) {
  return vehicle_colors[static_cast<std::size_t>(number) % vehicle_colors.size()];
}

}  // namespace sim
