// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sim/world/world.hpp"

namespace experiment {

/// Returns the words of sim::SignalLoss, as in `NAME.lost_CAUSE`.
const std::vector<std::string>& loss_causes();

/// Messages sent by modems, and the delivery of those addressed to them or broadcast to all of their kind.
struct LinkCounts {
  bool acoustic = false;                     ///< at least one acoustic modem exists; transponders do not count
  std::int64_t sent = 0;                     ///< packets
  std::int64_t bytes_sent = 0;               ///< in these packets
  std::int64_t received = 0;                 ///< receptions by addressees that decoded the packet
  std::int64_t unsent = 0;                   ///< requested without power, silenced by a fault, or out of the water
  std::int64_t dropped = 0;                  ///< messages rejected by a full queue
  std::map<std::string, std::int64_t> lost;  ///< not decoded, by cause: one of loss_causes()
};

/// Counts on the acoustic channel, for a vehicle (empty: all) and one of its devices (empty: all).
LinkCounts link_counts(const sim::World& world, const std::string& vehicle, const std::string& device);
/// Counts the same; for radio modems when none of these is acoustic.
LinkCounts any_link_counts(const sim::World& world, const std::string& vehicle, const std::string& device);

}  // namespace experiment
