// SPDX-License-Identifier: BSD-3-Clause
#include "motion/gait/half_ellipse.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "motion/gait/leg_motion.hpp"

namespace motion {

HalfEllipse::HalfEllipse(const sim::VehicleConfig& vehicle)
    : legs_(legs_of(vehicle)), vehicle_(vehicle.vehicle), frame_s_(frame_s_of(vehicle)) {
  // Ranges in proportion to the legs.  The start is a slow trot with small steps.
  const double front_m = reach_m(legs_[0]), rear_m = reach_m(legs_[2]);
  numbers_ = {{"front_height_m", 0.02 * front_m, 0.20 * front_m, 0.45 * front_m},
              {"front_x_m", -0.20 * front_m, 0.10 * front_m, 0.50 * front_m},
              {"front_y_m", 0, 0.03 * front_m, 0.25 * front_m},
              {"rear_height_m", 0.02 * rear_m, 0.20 * rear_m, 0.45 * rear_m},
              {"rear_x_m", -0.50 * rear_m, -0.10 * rear_m, 0.20 * rear_m},
              {"rear_y_m", 0, 0.03 * rear_m, 0.25 * rear_m},
              {"length_m", 0.1 * front_m, 0.35 * front_m, 1.0 * front_m},
              {"skew", -0.2, 0, 0.2},
              {"front_body_height_m", 0.50 * front_m, 0.75 * front_m, 0.95 * front_m},
              {"rear_body_height_m", 0.50 * rear_m, 0.75 * rear_m, 0.95 * rear_m},
              {"period_s", 0.28, 0.70, 1.0},
              {"ground_share", 0.3, 0.5, 0.7}};
}

int HalfEllipse::frames(std::span<const double> values) const {
  return 2 * std::max(2, static_cast<int>(std::lround(values[period] / frame_s_ / 2)));
}

sim::Vector3d HalfEllipse::foot_at(std::span<const double> values, const Leg& leg, double phase) {
  const std::size_t of_rear = is_front(leg) ? 0 : rear_height - front_height;
  const double ground = values[ground_share];
  // `skew` makes the strides of both sides differ, which turns the walk.
  const double half_m = values[length] / 2 * (1 + side_of(leg) * values[skew]);
  double x = 0, z = 0;
  // On the ground the foot moves back at a constant speed, or the body would jerk.
  if (phase < ground) {
    x = half_m * (1 - 2 * phase / ground);
  } else {
    const double angle = std::numbers::pi * (phase - ground) / (1 - ground);
    x = -half_m * std::cos(angle);
    z = values[front_height + of_rear] * std::sin(angle);
  }
  const double body_height_m = values[is_front(leg) ? front_body_height : rear_body_height];
  return leg.hip + sim::Vector3d(values[front_x + of_rear] + x,
                                 leg.foot.y() - leg.hip.y() + side_of(leg) * values[front_y + of_rear],
                                 z - body_height_m + leg.foot_radius_m);
}

sim::JointMotion HalfEllipse::motion(std::span<const double> values) const {
  const int count = frames(values);
  return leg_motion(vehicle_, legs_, count, frame_s_, CourseLimit::speed, [&](const Leg& leg, int frame) {
    // Diagonal legs together: left front and right rear first.
    const int first = (leg.name == "lf" || leg.name == "rh") ? 0 : count / 2;
    return leg.posture_at(foot_at(values, leg, static_cast<double>((frame + first) % count) / count));
  });
}

}  // namespace motion
