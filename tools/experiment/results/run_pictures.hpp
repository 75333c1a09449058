// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/world/world.hpp"
#include "tools/experiment/score/scoring.hpp"

namespace tools {

/// All the pictures that a results directory may have, in the order in which one looks at them.
inline constexpr const char* run_pictures[] = {"tracks.png", "errors.png", "errors_by_distance.png", "nees.png"};

/// What gnuplot shall do in a results directory; names its files without a directory, so that the folder can be moved
/// and plotted again.
std::string run_pictures_script(const sim::World& world, const Scoring& scoring);

}  // namespace tools
