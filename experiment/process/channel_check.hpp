// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bridges/lockstep/channel_use.hpp"
#include "sim/config/warnings.hpp"
#include "sim/world/world.hpp"
#include "sim/world_file/load_world.hpp"

namespace experiment {

/// Warns, at the end of a run, of what lockstep clients published where a device reports or nothing reads, and of
/// subscriptions to channels on which nothing was published.  Channels that the programs of the world declare are not
/// warned of, nor, in a run with a record (`is_recorded`), those that only the record reads, unless their name
/// resembles that of a channel that something reads.
void warn_of_channels(const sim::LoadedWorld& loaded, const sim::World& world, const bridges::ChannelUse& use,
                      bool is_recorded, sim::Warnings& warnings);

}  // namespace experiment
