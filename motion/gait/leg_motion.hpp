// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "motion/gait/leg.hpp"
#include "sim/motion/motion.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace motion {

/// How the courses of the joints of a gait are limited.
enum class CourseLimit {
  range,  ///< to the ranges of the servos: what a robot's program sends, however fast its servos are
  speed   ///< to their ranges and speeds
};

/// Returns the values with differences between neighbors of at most `step`, the last and the first being neighbors
/// too: midway between the highest such course below them and the lowest one above.
std::vector<double> with_limited_steps(const std::vector<double>& values, double step);

/// Returns the time between two frames of the vehicle's joint_group, s; 0.008 without one.
double frame_s_of(const sim::VehicleConfig& vehicle);

/// Returns the length of a leg from the hip to the ground when it is straight, m.
double reach_m(const Leg& leg);
bool is_front(const Leg& leg);
/// Returns 1 for a left leg, -1 for a right one.
double side_of(const Leg& leg);

/// Returns a motion that loops over a number of frames.  `posture_at`: desired posture of a leg in a frame.
sim::JointMotion leg_motion(const std::string& vehicle, const std::vector<Leg>& legs, int frames, double frame_s,
                            CourseLimit limit, const std::function<LegPosture(const Leg&, int frame)>& posture_at);

}  // namespace motion
