// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "motion/analysis/push_trials.hpp"
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

/// How the push margin is tested as a prediction of falls.
struct PredictionOptions {
  int motions = 200;  ///< that do not fall by themselves
  int pushes = 5;     ///< of each motion
  double row_s =
      0.2;  ///< time between the two instants of a motion whose margins are measured; pushes are between them
  std::uint64_t seed = 1;
  RandomMotionOptions motion;
  motion::PushOptions push;
};

/// A push at a random time, in a random direction and of a random strength, and what was predicted of it.
struct PushTrial {
  int motion = 0;  ///< number, from 1
  motion::Push push;
  bool fell = false;
  double withstood_mps = 0;          ///< predicted: greatest impulse over mass that does not make it fall; margin_at()
  double static_displacement_m = 0;  ///< greatest one in a static check of the pose, without the motion
};

/// Result of all trials.
struct PushTrials {
  std::vector<PushTrial> trials;
  int refused_motions = 0;  ///< that fell by themselves
};

/// Returns the impulse over mass that is withstood in a direction, rad, from those in the directions of a margin.
///
/// Between two directions the bound is a straight line in the plane of impulses, as when the vehicle tips over an edge.
double margin_at(const motion::PushMargin& margin, double direction_rad);

/// Draws motions from poses, measures margins of each at two instants, and pushes it between them.  The pushes are
/// drawn apart from those of the margins.  `stage.world` is a world file.
PushTrials push_trials(const motion::StageOptions& stage, const sim::VehicleConfig& vehicle,
                       const std::vector<sim::MotionPose>& poses, const PredictionOptions& options);

/// How well a prediction of falls does.
struct Detection {
  int found = 0, missed = 0, false_alarms = 0, right_passes = 0;
  double recall() const { return static_cast<double>(found) / (found + missed); }
  double precision() const { return static_cast<double>(found) / (found + false_alarms); }
  double f1() const { return 2.0 * found / (2 * found + missed + false_alarms); }
};

/// Counts how often the push margin was right: a fall is predicted when a push is above it.
Detection detection_by_margin(const std::vector<PushTrial>& trials);

/// Like detection_by_margin, for the static check: a fall is predicted when its displacement, times the push when
/// `by_push`, is above a threshold.  The threshold is the one of the best F1 over the trials themselves.
Detection detection_by_static_check(const std::vector<PushTrial>& trials, bool by_push);

}  // namespace verification
