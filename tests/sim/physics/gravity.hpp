// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace test {

inline constexpr double g = 9.80665;  ///< m/s^2, what a world has by default

}  // namespace test
