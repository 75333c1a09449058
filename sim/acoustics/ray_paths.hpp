// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sim/acoustics/multipath.hpp"
#include "sim/acoustics/rays/eigenrays.hpp"

namespace sim {

/// Computes gain and phase of rays, in their order: spreading over their length by the configured law, focusing by the
/// ray tube relative to a straight path of this length (at most Propagation::max_focus_dB), absorption, bounces and
/// caustics.  `multipath`: needed for rays with bounces.
std::vector<PathGain> ray_gains(std::span<const SoundRay> rays, const MultipathConfig* multipath,
                                const MultipathMedium& water);

/// Path to which a receiver locks: the earliest one at most `first_path_dB` weaker than the strongest.  There
/// must be a path.
std::size_t first_path(std::span<const PathGain> paths);
inline constexpr double first_path_dB = 10;

}  // namespace sim
