// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/config/warnings.hpp"

namespace sim {

class World;

/// What was warned of while the world was built, and of what came since; a world that is built again after a restore
/// says nothing twice.
Warnings& warnings_of(World& world);

}  // namespace sim
