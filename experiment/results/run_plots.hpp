// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "experiment/score/scoring.hpp"
#include "sim/world/world.hpp"

namespace experiment {

/// Names of all plots that a results directory may have, in order of presentation.
inline constexpr const char* run_plots[] = {"tracks.png", "errors.png", "errors_by_distance.png", "nees.png"};

/// Returns the gnuplot commands for a results directory; they name files without a directory, so that the folder can be
/// moved and plotted again.
std::string run_plots_script(const sim::World& world, const Scoring& scoring);

}  // namespace experiment
