// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "shoal/modem_received_t.hpp"
#include "shoal/modem_send_t.hpp"
#include "shoal/position_report_t.hpp"
#include "tools/autonomy/filters/pose2.hpp"

namespace autonomy {

/// Message for a modem that broadcasts the report.
shoal::modem_send_t broadcast(const shoal::position_report_t& report);

/// The last report of each other rover, as received over the modem.
class PositionReports {
 public:
  static constexpr double oldest_s = 3.0;
  static constexpr double max_speed_mps = 10.0;

  struct Neighbour {
    Vector2d p_W;
    double std_m;
  };

  /// Throws shoal::MessageError when the bytes are not a plausible report: any program may send anything.
  void receive(const shoal::modem_received_t& packet);
  /// Where a rover is at `utime` by its last report, and that report is used up: its error would count again
  /// and again with every sighting, though it is the same.  Nothing when there is no unused report or it is
  /// too old.
  std::optional<Neighbour> take(const std::string& vehicle, std::int64_t utime);

 private:
  std::map<std::string, shoal::position_report_t, std::less<>> unused_;
};

}  // namespace autonomy
