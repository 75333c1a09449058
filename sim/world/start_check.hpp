// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace sim {

class Warnings;
class World;

/// Warns of vehicles and free objects that start more than 1 cm inside another entity, or below terrain: contact forces
/// push them out, or they fall forever; and of craft that start in the air above water.  Must be called when the world
/// is built.
void warn_of_starts(const World& world, Warnings& warnings);

}  // namespace sim
