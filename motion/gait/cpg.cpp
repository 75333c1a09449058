// SPDX-License-Identifier: BSD-3-Clause
#include "motion/gait/cpg.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "motion/gait/leg_motion.hpp"

namespace motion {

namespace {

using std::numbers::pi;

}  // namespace

Cpg::Cpg(const sim::VehicleConfig& vehicle)
    : legs_(legs_of(vehicle)), vehicle_(vehicle.vehicle), frame_s_(frame_s_of(vehicle)) {
  numbers_ = {{"period_s", 0.28, 0.70, 1.2},           {"swing_amplitude_rad", 0.05, 0.20, 0.7},
              {"knee_amplitude_rad", 0.05, 0.40, 1.2}, {"knee_phase", -0.25, 0, 0.25},
              {"front_swing_rad", -1.2, -0.35, 0.6},   {"rear_swing_rad", -0.6, 0.35, 1.2},
              {"front_knee_rad", 0.2, 0.90, 1.7},      {"rear_knee_rad", 0.2, 0.90, 1.7}};
}

LegPosture Cpg::posture_at(std::span<const double> values, const Leg& leg, double phase) {
  const bool front = is_front(leg);
  // Forward is a turn against +y.
  const double forward = -leg.swing_sign;
  const double middle = values[front ? front_swing : rear_swing], bend = values[front ? front_knee : rear_knee];
  LegPosture posture;
  posture.swing = forward * (middle + values[swing_amplitude] * std::sin(2 * pi * phase));
  posture.flap = 0;
  posture.knee = bend + values[knee_amplitude] * (1 + std::cos(2 * pi * (phase - values[knee_phase]))) / 2;
  return posture;
}

sim::JointMotion Cpg::motion(std::span<const double> values) const {
  const int count = 2 * std::max(2, static_cast<int>(std::lround(values[period] / frame_s_ / 2)));
  return leg_motion(vehicle_, legs_, count, frame_s_, CourseLimit::speed, [&](const Leg& leg, int frame) {
    const int first = (leg.name == "lf" || leg.name == "rh") ? 0 : count / 2;
    return posture_at(values, leg, static_cast<double>((frame + first) % count) / count);
  });
}

}  // namespace motion
