// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sim/acoustics/multipath.hpp"
#include "sim/acoustics/rays/eigenrays.hpp"

namespace sim {

/// Computes gain and phase of rays, in their order: spreading by the ray tube (nothing is louder than at 1 m), by waves
/// where twins merge at a caustic, absorption, bounces, and the caustics that they have passed.  `multipath`: needed
/// for rays with bounces.
std::vector<PathGain> ray_gains(std::span<const SoundRay> rays, const MultipathConfig* multipath,
                                const MultipathMedium& water);

/// Path to which a receiver locks: the earliest one at most `first_path_dB` weaker than the strongest.  There
/// must be a path.
std::size_t first_path(std::span<const PathGain> paths);
inline constexpr double first_path_dB = 10;

}  // namespace sim
