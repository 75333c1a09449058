// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "autonomy/cooperative/driver/nav_team.hpp"

namespace navigation {

/// Deviations of the pose of a land vehicle at the start, which the world gives.
inline constexpr double land_start_std_m = 0.1;  ///< of east and north
inline constexpr double land_start_heading_std_rad = 0.03;

/// Whether a world is one of land vehicles: no acoustic modem.
bool is_on_land(const sim::WorldConfig& world);

/// Returns the team of a world on land, with the errors that the metric `bound` uses.  In a world without any devices,
/// an imported data set of MR.CLAM, all vehicles have the errors of its robots.  Throws std::invalid_argument when no
/// vehicle has odometry.
NavTeam land_team_of(const sim::WorldConfig& world);

}  // namespace navigation
