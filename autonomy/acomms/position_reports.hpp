// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "autonomy/filters/pose2.hpp"
#include "shoal/modem_received_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "shoal/position_report_t.hpp"

namespace autonomy {

/// Returns the message for a modem that broadcasts the report.
shoal::modem_send_t broadcast(const shoal::position_report_t& report);

/// Last report of each other rover, as received over the modem.
class PositionReports {
 public:
  static constexpr double oldest_s = 3.0;
  static constexpr double max_speed_mps = 10.0;

  struct Neighbor {
    Vector2d p_W;
    double std_m;
  };

  /// Throws shoal::MessageError for bytes that are not a plausible report, because any program may send anything.
  void receive(const shoal::modem_received_t& packet);
  /// Returns the position of a rover at `utime` by its last report, and marks that report as used: its error is the
  /// same at every detection and must not be counted repeatedly.  std::nullopt when there is no unused report or it
  /// is too old.
  std::optional<Neighbor> take(const std::string& vehicle, std::int64_t utime);

 private:
  std::map<std::string, shoal::position_report_t, std::less<>> unused_;
};

}  // namespace autonomy
