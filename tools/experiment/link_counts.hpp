#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "sim/world/world.hpp"

namespace tools {

/// What became of packets on the acoustic channel.
struct LinkCounts {
  std::int64_t sent = 0;        ///< packets
  std::int64_t bytes_sent = 0;  ///< in them
  std::int64_t received = 0;    ///< of the packets, by all who heard them: a broadcast may count more than once
  std::map<std::string, std::int64_t> lost;  ///< by cause, one of sim::loss_causes(); counted as `received` is
};

/// Of the packets that the modems of a vehicle sent (empty: of all), or one of them (`device`; empty: all).
LinkCounts link_counts(const sim::World& world, const std::string& vehicle, const std::string& device);

}  // namespace tools
