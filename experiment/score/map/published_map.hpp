// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "bridges/log/event_log.hpp"
#include "experiment/score/map/grid_map.hpp"

namespace experiment {

/// Map that a program published, with its time.
struct PublishedMap {
  std::int64_t utime = 0;
  GridMap map;
};

/// Decodes a shoal.occupancy_grid_t.  A cell from 65 % on is occupied, to 20 % free, otherwise unknown, as map_server
/// reads maps.  Throws shoal::MessageError for another type, impossible sizes, and more than max_map_cells cells.
PublishedMap decode_map(std::span<const std::byte> payload);

/// Maps on a channel of an LCM event log, in the order of their times.
class PublishedMaps {
 public:
  /// Throws std::runtime_error when the log cannot be read or has no message on this channel.
  PublishedMaps(const std::string& log, std::string channel);

  /// Returns the last map published up to a simulated time; `at_s` must not decrease.  std::nullopt after the end
  /// of the log.  Throws std::runtime_error when it cannot be decoded, and before the first map.
  std::optional<GridMap> at(double at_s);

 private:
  bool read_next();
  void learn_epoch(std::span<const std::byte> payload);

  std::string log_, channel_;
  bridges::EventLogReader reader_;
  std::optional<std::int64_t> epoch_utime_;  ///< of step 0; in a log without sim.info the time of its first event
  bool knows_epoch_ = false;
  std::optional<bridges::LogEvent> next_;  ///< the first event on the channel that was not used
  double next_s_ = 0;
  double last_event_s_ = 0;
  std::optional<sim::Bytes> last_;
};

}  // namespace experiment
