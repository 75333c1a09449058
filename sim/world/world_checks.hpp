// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

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

/// Returns a warning when vehicles in or on water have no bottom below them and a device that needs one, because it
/// casts rays under water or declares it (Sensor::needs_bottom).
std::vector<std::string> bottom_warnings(const World& world);
/// Returns the same for one vehicle.
std::vector<std::string> bottom_warnings(const World& world, const Vehicle& vehicle);

/// Returns the warnings of the end of a run: what WorldWarnings has kept for it, and the sensors whose readings have
/// all lacked something, such as a lock or a fix, for a minute or more.  `is_awaited`: returns whether a program waits
/// for the reports on a channel, without which it is usual that a GPS under water has no fix.
std::vector<std::string> end_warnings(const World& world, const std::function<bool(const std::string&)>& is_awaited);

/// Warns of vehicles and free objects that start more than 1 cm inside another entity, or below terrain: contact forces
/// push them out, or they fall forever; and of craft that start in the air above water.  Must be called when the world
/// is built.
void warn_of_starts(const World& world, Warnings& warnings);

}  // namespace sim
