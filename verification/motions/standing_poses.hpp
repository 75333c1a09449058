// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "motion/analysis/connect.hpp"

namespace verification {

/// Random poses in which a vehicle stands.
struct StandingPoses {
  std::vector<sim::JointValues> poses;
  int tried = 0;
};

/// Draws poses of the legs of a vehicle until it stands still in `count` of them, without its first body on the ground,
/// when it moves there from the start of the run.  Swings are within 60 degrees, flaps up to 30, knees from 0 to 100.
/// Throws ConfigError when it has not the legs for it.
StandingPoses standing_poses(const sim::WorldConfig& world, const std::string& vehicle, int count, std::uint64_t seed);

}  // namespace verification
