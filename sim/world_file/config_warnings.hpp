// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>
#include <string>

#include "sim/config/warnings.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

/// Warns of settings of a world file that cannot take effect: rates above that of the steps, keys without effect,
/// metrics of channels without a publisher or that start after the end, events after the end.  `root`: what `world`
/// was read from; `duration_s`: of the run, where it is not that of the file, 0: without end.  A shorter run is not a
/// reason for a warning.  Call when the vehicles are known and there were no errors.
void warn_of_config(const WorldConfig& world, const ConfigNode& root, Warnings& warnings,
                    std::optional<double> duration_s = {});

/// The channels on which the world itself speaks: reports and truths of its devices, and what its events publish.
std::set<std::string> channels_of(const WorldConfig& world);

/// The channels to which the world itself subscribes: commands of its devices, and what metrics and conditions name.
std::set<std::string> subscribed_channels_of(const WorldConfig& world);

}  // namespace sim
