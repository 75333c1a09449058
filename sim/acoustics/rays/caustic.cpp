// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/rays/caustic.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sim {

CausticChange caustic_change(double apart_rad) {
  constexpr double pi = std::numbers::pi;
  const double z = std::max(apart_rad / 2, 1e-30);
  // Beyond, the change is less than 1e-5 and 1 mrad.
  constexpr double far = 100;
  if (z > far) return {};
  const double j = std::cyl_bessel_j(1.0 / 3, z), y = std::cyl_neumann(1.0 / 3, z);
  return {pi * z / 2 * (j * j + y * y), std::remainder(std::atan2(y, j) + pi / 6 - (z - pi / 4), 2 * pi)};
}

}  // namespace sim
