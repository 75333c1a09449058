// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/motion/motion.hpp"
#include "sim/random/random.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace verification {

/// How motions are drawn.
struct RandomMotionOptions {
  int keys = 5;
  double least_key_s = 0.3, greatest_key_s = 1;  ///< time between two keys
  double offset = 0.3;                           ///< from a pose, of each of its joints: up to this, rad or m
};

/// Draws a motion: a pose, then keys that each have a pose with random offsets.  Joints that no pose names have random
/// values of their range.  Ranges and velocities of the servos are kept, for which a key may be later than drawn.
sim::JointMotion random_motion(const std::vector<sim::MotionPose>& poses, const sim::VehicleConfig& vehicle,
                               const RandomMotionOptions& options, sim::Random& random);

}  // namespace verification
