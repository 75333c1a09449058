// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "viewer/estimates/vehicle_estimate.hpp"

namespace viewer {

/// Position estimate in a log.
struct LogEstimate : VehicleEstimate {
  double time_s = 0;  ///< simulated time at which it was valid, by the clock of the vehicle
};

/// Position estimates that the programs of a recorded run published on `VEHICLE.estimate`, by time.
class LogEstimates {
 public:
  LogEstimates() = default;
  /// Reads the estimates of a log from `from_s` to `until_s`, at most one of a vehicle in each `interval_s`.  Of
  /// several branches the last one counts.  Throws bridges::BusError when the log cannot be read.
  LogEstimates(const std::string& log, double from_s, double until_s, double interval_s);

  /// Returns the last estimate of a vehicle up to a time, none older than `max_age_s`.
  const LogEstimate* find(const std::string& vehicle, double time_s, double max_age_s) const;
  /// Returns the vehicles of which there are estimates, by name.
  std::vector<std::string> vehicles() const;

 private:
  void add(std::string_view channel, const LogEstimate& estimate, double interval_s);

  std::map<std::string, std::vector<LogEstimate>, std::less<>> by_vehicle_;
};

}  // namespace viewer
