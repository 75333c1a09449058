// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/physics/physics_world.hpp"
#include "sim/scene/scene.hpp"

namespace devices {

/// What stops the rays of a sensor: not the parts of the categories it sees through, nor, unless it sees it, the group
/// of its own vehicle.
sim::RayFilter make_ray_filter(const sim::PhysicsWorld& physics, sim::RayKind kind,
                               const std::vector<std::string>& see_through, int own_group, bool sees_own_vehicle);

}  // namespace devices
