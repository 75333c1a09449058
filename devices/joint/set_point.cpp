// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/set_point.hpp"

#include <algorithm>
#include <cmath>

namespace devices {

namespace {

/// Returns the highest velocity for this step from which it stops exactly after `distance`, when the velocity decreases
/// in each further step by change = acceleration * step_s.  With m such steps to come, v = m change + f and distance /
/// step_s = v + (v - change) + ... + f = (m + 1) (m change / 2 + f), 0 <= f <= change.
double stopping_velocity(double distance, double acceleration, double step_s) {
  if (distance <= 0) return 0;
  const double at_once = distance / step_s;
  if (std::isinf(acceleration) || std::isinf(distance)) return at_once;
  const double change = acceleration * step_s;
  const double m = std::floor((std::sqrt(1 + 8 * at_once / change) - 1) / 2);
  return m * change / 2 + at_once / (m + 1);
}

}  // namespace

void SetPoint::advance(double desired_velocity, const Limits& limits, double step_s) {
  const double change = limits.acceleration * step_s;
  velocity += std::clamp(desired_velocity - velocity, -change, change);
  position += velocity * step_s;
}

void SetPoint::approach(double target, const Limits& limits, double step_s) {
  const double distance = target - position;
  const double upper = std::min(limits.velocity, stopping_velocity(std::abs(distance), limits.acceleration, step_s));
  advance(std::copysign(upper, distance), limits, step_s);
  if (std::abs(target - position) < 1e-12) position = target;  // rounding
}

void SetPoint::run(double target_velocity, double low, double high, const Limits& limits, double step_s) {
  const double up = stopping_velocity(high - position, limits.acceleration, step_s);
  const double down = stopping_velocity(position - low, limits.acceleration, step_s);
  advance(std::clamp(std::clamp(target_velocity, -limits.velocity, limits.velocity), -down, up), limits, step_s);
}

}  // namespace devices
