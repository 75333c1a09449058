// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/physics/physics_world.hpp"
#include "sim/scene/scene.hpp"

namespace devices {

/// Returns the filter of the rays of a sensor.  It excludes parts of the categories `see_through` and, unless
/// `sees_own_vehicle`, the group of the sensor's vehicle.
sim::RayFilter make_ray_filter(const sim::PhysicsWorld& physics, sim::RayKind kind,
                               const std::vector<std::string>& see_through, int own_group, bool sees_own_vehicle);

}  // namespace devices
