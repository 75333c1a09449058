// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace autonomy {

// Bounds by the chi-square distribution of squared innovations and errors over their (co)variance.
inline constexpr double chi_square_999_1 = 10.83;             ///< 99.9 %, 1 degree of freedom
inline constexpr double chi_square_999_2 = 13.82;             ///< 99.9 %, 2 degrees of freedom
inline constexpr double chi_square_95_2 = 5.991464547107979;  ///< 95 %, 2 degrees of freedom

}  // namespace autonomy
