// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace sim {

class Warnings;
class World;

/// Warns of vehicles and of objects that are free to move that start more than 1 cm deep in something else, or below
/// terrain: physics pushes them out, or they fall forever.  Call when the world is built.
void warn_of_starts(const World& world, Warnings& warnings);

}  // namespace sim
