// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/base/time.hpp"

namespace tools {

/// Position estimate of a vehicle.
struct FilmEstimate {
  double time_s = 0;  ///< at which it was valid, by the clock of the vehicle
  sim::Vector3d position_m = sim::Vector3d::Zero();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
};

/// Position estimates that the programs of a recorded run published on `VEHICLE.estimate`, by time.
class LogEstimates {
 public:
  LogEstimates() = default;
  /// Reads the estimates of a log from `from_s` to `until_s`, at most one of a vehicle in each `interval_s`.  Of
  /// several branches the last one counts.  Throws bridges::BusError when the log cannot be read.
  LogEstimates(const std::string& log, double from_s, double until_s, double interval_s);

  /// Returns the last estimate of a vehicle up to a time, none older than `max_age_s`.
  const FilmEstimate* find(const std::string& vehicle, double time_s, double max_age_s) const;
  bool empty() const { return by_vehicle_.empty(); }

 private:
  void add(std::string_view channel, const FilmEstimate& estimate, double interval_s);

  std::map<std::string, std::vector<FilmEstimate>, std::less<>> by_vehicle_;
};

}  // namespace tools
