// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/filters/odometer.hpp"

namespace autonomy {

Increment Odometer::update(const Vector2d& p_0, double theta_rad) {
  const Vector2d moved = turned(p_0 - p_0_, -theta_rad_);
  const Increment increment{moved.x(), moved.y(), theta_rad - theta_rad_};
  p_0_ = p_0;
  theta_rad_ = theta_rad;
  return increment;
}

}  // namespace autonomy
