// SPDX-License-Identifier: BSD-3-Clause
#include "motion/gait/leg_motion.hpp"

#include <algorithm>

#include "devices/motion/joint_group.hpp"

namespace motion {

std::vector<double> with_limited_steps(const std::vector<double>& values, double step) {
  const std::size_t n = values.size();
  std::vector<double> limited;
  for (std::size_t i = 0; i < n; ++i) {
    // The smallest function above and the largest below the values with bounded steps. Their mean has bounded steps,
    // too, and no lag.
    double above = values[i], below = values[i];
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t apart = i > j ? i - j : j - i;
      const double room = step * static_cast<double>(std::min(apart, n - apart));
      above = std::max(above, values[j] - room);
      below = std::min(below, values[j] + room);
    }
    limited.push_back((above + below) / 2);
  }
  return limited;
}

double frame_s_of(const sim::VehicleConfig& vehicle) {
  double frame_s = 0.008;
  for (const sim::DeviceConfig& device : vehicle.devices)
    if (const auto* group =
            dynamic_cast<const sim::detail::ParamsOf<devices::JointGroup::Params>*>(device.params.get()))
      frame_s = group->params.frame_s;
  return frame_s;
}

double reach_m(const Leg& leg) {
  return (leg.knee - leg.hip).norm() + (leg.foot - leg.knee).norm() + leg.foot_radius_m;
}

bool is_front(const Leg& leg) {
  return leg.name == "lf" || leg.name == "rf";
}

double side_of(const Leg& leg) {
  return leg.hip.y() > 0 ? 1 : -1;
}

sim::JointMotion leg_motion(const std::string& vehicle, const std::vector<Leg>& legs, int frames, double frame_s,
                            CourseLimit limit, const std::function<LegPosture(const Leg&, int frame)>& posture_at) {
  sim::JointMotion motion;
  motion.name = "walk";
  motion.vehicle = vehicle;
  motion.angles = sim::AngleUnit::rad;
  motion.loop = true;
  motion.frame_s = frame_s;
  motion.start = {.max_velocity = 2, .min_s = 0.5};
  // One key more than frames: the last one repeats the first, so that the loop closes.
  motion.keys.resize(static_cast<std::size_t>(frames) + 1);
  for (int i = 0; i <= frames; ++i) motion.keys[static_cast<std::size_t>(i)].at_s = i * frame_s;
  for (const Leg& leg : legs) {
    std::vector<double> swing, flap, knee;
    for (int i = 0; i < frames; ++i) {
      const LegPosture posture = posture_at(leg, i);
      swing.push_back(std::clamp(posture.swing, leg.swing_limits.low, leg.swing_limits.high));
      flap.push_back(std::clamp(posture.flap, leg.flap_limits.low, leg.flap_limits.high));
      knee.push_back(std::clamp(posture.knee, leg.knee_limits.low, leg.knee_limits.high));
    }
    const auto add = [&](const char* joint, const std::vector<double>& desired, const LegJointLimits& limits) {
      const std::vector<double> course =
          limit == CourseLimit::speed ? with_limited_steps(desired, limits.max_velocity * frame_s) : desired;
      for (std::size_t i = 0; i < motion.keys.size(); ++i)
        motion.keys[i].joints.emplace_back(leg.name + joint, course[i % course.size()]);
    };
    add("_swing", swing, leg.swing_limits);
    add("_flap", flap, leg.flap_limits);
    add("_knee", knee, leg.knee_limits);
  }
  return motion;
}

}  // namespace motion
