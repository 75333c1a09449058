// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>

#include "sim/config/warnings.hpp"
#include "sim/world_file/load_world.hpp"

namespace experiment {

/// Warns of programs of a world that cannot work as configured, judging by their `args:` and declarations:
/// overlapping slots, a vehicle to follow that does not exist or never sends, a different name in the lockstep (all for
/// programs that come with Shoal), metrics of channels on which none of the programs publishes.
void warn_of_processes(const sim::LoadedWorld& loaded, sim::Warnings& warnings);

/// Returns the channels that the programs of a world publish on or subscribe to, by their declarations.
std::set<std::string> channels_of_programs(const sim::LoadedWorld& loaded);

/// Warns of programs that cannot be started: they are neither in the folder of the running program nor in PATH.
void warn_of_missing_programs(const sim::LoadedWorld& loaded, sim::Warnings& warnings);

/// Warns of a `command:` whose program has a declaration, by which `args:` could be checked.
void warn_of_unchecked_arguments(const sim::LoadedWorld& loaded, sim::Warnings& warnings);

}  // namespace experiment
