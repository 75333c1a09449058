// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/avoid_behavior.hpp"

#include <cmath>

namespace autonomy {

Course Avoidance::steer(const Motion& own, const Course& desired) {
  Course course = desired;
  drift_.update(own);
  if (std::isfinite(own.yaw_rad)) course = law_->steer(own, drift_.drift_W(), desired, tracks_.at(own.utime));
  drift_.command(course);
  return course;
}

Course AvoidBehavior::steer(const Motion& own) {
  const Course desired = inner_->steer(own);
  return inner_->finished() ? desired : avoidance_.steer(own, desired);
}

}  // namespace autonomy
