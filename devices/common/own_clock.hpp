// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "sim/base/time.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace devices {

/// Returns the first true time, not before `from`, at which the vehicle clock shows a whole multiple of `period` (in
/// UTC, including the epoch of the run).
inline sim::Time next_whole(const sim::Vehicle& vehicle, std::int64_t epoch_us, sim::Time from, sim::Time period) {
  // Use the clock error, not the reading: the resolution of the clock may be coarser than the period.
  const std::int64_t utc_us = epoch_us + (from + sim::from_seconds(vehicle.clock().error_s(from))).count();
  std::int64_t over_us = utc_us % period.count();
  if (over_us < 0) over_us += period.count();
  if (over_us == 0) return from;
  const sim::Time at = vehicle.clock().true_time(sim::Time{utc_us + period.count() - over_us - epoch_us});
  return at < from ? from : at;
}

}  // namespace devices
