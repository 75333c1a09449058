// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/base/math.hpp"

namespace sim {

class Vehicle;
class Warnings;
class World;

/// Returns what is wrong with a depth below the still surface at a place: `depth -15 m is in the air ...`, `depth 55 m
/// is below the bottom, which is at 40 m there`; empty: nothing, or the world has no water.  The bottom is a plane, a
/// terrain or a fixed object that surrounds the point.
std::string depth_fault(const World& world, const Eigen::Vector2d& p_W, double depth_m);

/// Warns of the first place of each device, see Sensor::planned_places(), that is below the bottom or in the air.
void warn_of_plans(const World& world, const Vehicle& vehicle, Warnings& warnings);

}  // namespace sim
