// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace sim {

class World;

/// Warns, with the time of the world, of something that is worth to know and no bad message: those are for
/// World::complain, which counts them.
void notice(const World& world, const std::string& who, const std::string& text);

}  // namespace sim
