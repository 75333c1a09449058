// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "experiment/drive/drive_profile.hpp"
#include "sim/world/world.hpp"

namespace viewer {

/// Returns the text `forms` for a page (docs/develop/view_protocol.md): the actions of `shoal control do` with their
/// keys, the faults that each type of device takes, the events, objects and actors of the world, and how its vehicles
/// can be driven.
std::string forms_text(const sim::World& world, const experiment::DriveProfile& profile);

}  // namespace viewer
