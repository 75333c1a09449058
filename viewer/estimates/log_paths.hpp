// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "viewer/estimates/vehicle_path.hpp"

namespace viewer {

/// Paths that the programs of a recorded run published, by channel and time.
class LogPaths {
 public:
  LogPaths() = default;
  /// Reads the paths of a log up to `until_s`.  If it has several branches, the last one counts.  Throws
  /// bridges::BusError when the log cannot be read.
  LogPaths(const std::string& log, double until_s);

  /// Returns the last path of each channel up to a time, by channel; an empty one ends that before it.
  std::vector<std::pair<std::string, const VehiclePath*>> at(double time_s) const;

 private:
  struct Dated {
    double time_s;  ///< by the clock of the vehicle
    VehiclePath path;
  };
  std::map<std::string, std::vector<Dated>, std::less<>> by_channel_;
};

}  // namespace viewer
