// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "motion/analysis/motion_stage.hpp"

namespace motion {

/// Bytes that a world in a take may have, as YAML.
constexpr std::size_t max_embedded_bytes = 1'000'000;

/// Returns a resolved world as a take holds it: under its name, without programs, and with the motions of its players
/// in place of their files.  Throws sim::ConfigError when it names other files, has plugins, or is too large.
sim::ConfigNode embeddable_world(const sim::ConfigNode& resolved, const std::string& name);

/// Writes a world of embeddable_world() into a take.  Throws sim::ConfigError, std::runtime_error when it cannot be
/// written.
void embed_world(const std::string& take, const sim::ConfigNode& world);

/// Sets a stage to the world in a take, which may be a stranger's: it cannot name files.  Returns false when the take
/// holds none.  Throws sim::ConfigError when that is not a world as above.
bool use_embedded_world(StageOptions& stage, const sim::JointMotion& take, const std::string& take_path);

}  // namespace motion
