// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>

#include "bridges/lockstep/channel_use.hpp"
#include "sim/config/warnings.hpp"
#include "sim/world/world.hpp"
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

/// Warns, at the end of a run, of what lockstep clients published where a device reports or nothing reads, and of
/// subscriptions to channels on which nothing was published.  Channels that the programs of the world declare are not
/// warned of, nor, in a run with a record (`is_recorded`), those that only the record reads, unless their name
/// resembles that of a channel that something reads.
void warn_of_channels(const sim::LoadedWorld& loaded, const sim::World& world, const bridges::ChannelUse& use,
                      bool is_recorded, sim::Warnings& warnings);

}  // namespace experiment
