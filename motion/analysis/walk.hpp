// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "sim/motion/motion.hpp"
#include "sim/world_file/world_config.hpp"

namespace motion {

/// How a walk is measured.
struct WalkOptions {
  double warm_up_s = 1;  ///< of walking before the measurement
  double measured_s = 4;
  double sideways = 0.3;  ///< share of the sideways speed that is subtracted
};

/// Result of a walk.
struct Walk {
  bool fell = false;        ///< it tilted by more than 45 degrees, its first body touched something, or it diverged
  double at_s = 0;          ///< time of the run at the fall, or at the end
  double forward_mps = 0;   ///< along the direction at the start of the run
  double sideways_mps = 0;  ///< to the left
  double ahead_mps = 0;     ///< mean of the speed towards where its nose points at each instant, level
  double turn_radps = 0;    ///< mean, counter-clockwise
  double value_mps = 0;  ///< forward less a share of sideways; after a fall between -0.3 and -0.1, the later the better
  std::uint64_t state_hash = 0;
};

/// Plays a motion that loops in its own world.  `world` is one of world_for_walks().  May be called by several
/// threads.
Walk measured_walk(sim::WorldConfig world, const std::string& vehicle, const sim::JointMotion& motion,
                   const WalkOptions& options);

}  // namespace motion
