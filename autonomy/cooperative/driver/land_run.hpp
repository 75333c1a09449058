// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "autonomy/cooperative/driver/land_events.hpp"
#include "autonomy/cooperative/driver/offline.hpp"

namespace navigation {

/// An algorithm with the events of a record on land.
///
/// The vehicles start at their places in the world.  Whatever a vehicle sends by radio becomes a frame with the payload
/// of the algorithm and the velocity of the sender; the next relative measurement of the sender within 3 s has this
/// payload, and is corrected by the distance that the sender traveled since.  Further relative measurements have no
/// payload.  In a record without radio messages every relative measurement has a payload of that instant.  A
/// TeamEstimator needs no payloads, and uses every relative measurement.
class LandRun {
 public:
  LandRun(const NavRecord& record, const Algorithm& algorithm, const std::vector<NavOptions>& options, OfflineRun& run);

  /// Makes all calls, with an estimate of each vehicle after each period of the first one's options.
  void play();

 private:
  /// How far the estimators have moved a vehicle.
  struct Walk {
    std::size_t next = 0;  ///< segment
    Time moved_to = 0;
  };
  /// Moves a vehicle up to a time; with `part` also by the segment that is not complete by then.
  void walk(int vehicle, Time time, bool part);
  void ticks_before(Time time);
  void tell(int vehicle, const NavEvent& event);

  const NavRecord& record_;
  OfflineRun& run_;
  LandEvents events_;
  bool needs_payloads_;  ///< one estimator in each vehicle
  bool has_radio_;
  std::unique_ptr<TeamEstimator> team_;
  std::vector<Walk> walks_;
  Time period_us_;
  Time tick_us_ = 0;
};

}  // namespace navigation
