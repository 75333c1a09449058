// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/medium/medium_config.hpp"
#include "sim/medium/water_column.hpp"

namespace sim {

/// Depth (m) of the first row of the profile whose water is lighter than that of the row above it.  With an equation of
/// state, densities are compared at the same pressure, with a margin for well-mixed water.  `column`: of this water.
std::optional<double> unstable_at_m(const WaterConfig& water, const WaterColumn& column);

}  // namespace sim
