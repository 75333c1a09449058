// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/world/world.hpp"
#include "tools/experiment/score/scoring.hpp"

namespace tools {

/// All plots that a results directory may have, in order of presentation.
inline constexpr const char* run_plots[] = {"tracks.png", "errors.png", "errors_by_distance.png", "nees.png"};

/// Commands for gnuplot in a results directory; names its files without a directory, so that the folder can be moved
/// and plotted again.
std::string run_plots_script(const sim::World& world, const Scoring& scoring);

}  // namespace tools
