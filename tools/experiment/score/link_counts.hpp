// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sim/world/world.hpp"

namespace tools {

/// The words of the sim::SignalLoss, as in `NAME.lost_CAUSE`.
const std::vector<std::string>& loss_causes();

/// Messages sent by modems, and the delivery of those addressed to them or to all of their kind.
struct LinkCounts {
  bool acoustic = false;                     ///< there are some that are: not transponders and the like
  std::int64_t sent = 0;                     ///< packets
  std::int64_t bytes_sent = 0;               ///< in them
  std::int64_t received = 0;                 ///< as often as one that a packet was for understood it
  std::int64_t unsent = 0;                   ///< asked for without power, silent by a fault, or out of the water
  std::int64_t dropped = 0;                  ///< messages that waited in a queue that was full
  std::map<std::string, std::int64_t> lost;  ///< not understood, by cause: one of loss_causes()
};

/// On the acoustic channel, of a vehicle (empty: of all) and one of its devices (empty: of all).
LinkCounts link_counts(const sim::World& world, const std::string& vehicle, const std::string& device);
/// The same; of modems by radio where none of these is acoustic.
LinkCounts any_link_counts(const sim::World& world, const std::string& vehicle, const std::string& device);

}  // namespace tools
