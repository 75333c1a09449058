// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>
#include <string>

#include "sim/config/warnings.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

/// Warns of settings of a world file that cannot take effect: rates above the step rate, keys without effect, metrics
/// of channels without a publisher or that start after the end, events after the end.  `root`: tree from which `world`
/// was read; `duration_s`: duration of the run instead of that of the file, 0: unlimited.  A shorter run causes no
/// warning.  Must be called after the vehicles were loaded without errors.
void warn_of_config(const WorldConfig& world, const ConfigNode& root, Warnings& warnings,
                    std::optional<double> duration_s = {});

/// Returns the channels on which the world publishes: reports and truth channels of its devices, and those of its
/// events.
std::set<std::string> channels_of(const WorldConfig& world);

/// The channels to which the world itself subscribes: commands of its devices, and what metrics and conditions name.
std::set<std::string> subscribed_channels_of(const WorldConfig& world);

}  // namespace sim
