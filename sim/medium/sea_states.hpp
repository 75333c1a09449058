// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace sim {

/// Significant wave height of sea states 0 to 8, m: the middle of its range (Lee and Bales 1984, as in STANAG 4194).
inline constexpr std::array<double, 9> hs_of_sea_state_m{0, 0.05, 0.3, 0.88, 1.88, 3.25, 5, 7.5, 11.5};

}  // namespace sim
