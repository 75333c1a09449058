// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "autonomy/cooperative/driver/navigator.hpp"

namespace navigation {

/// Collects the events of all vehicles, and makes the calls of a TeamEstimator in the order of their times.  The clocks
/// of the vehicles are taken as equal for this order, except that no frame is received before it was said.
class TeamNavigator {
 public:
  explicit TeamNavigator(std::size_t vehicles) : vehicles_(vehicles) {}

  void start(int vehicle, const Setup& setup);
  void add(int vehicle, const NavEvent& event);
  /// A frame is transmitted at `time`, which is ReceivedRange::payload_time for its receivers.
  void sent(int vehicle, Time time, Time frame_time);
  /// Asks for the estimate at a time.
  void query(int vehicle, Time time, std::function<void(const Estimate&)> answer);
  /// Makes all calls.
  void run(TeamEstimator& estimator);

 private:
  struct Call {
    enum class Kind { start, event, sent, query };
    Kind kind = Kind::event;
    int vehicle = 0;
    Time time = 0;  ///< by the clock of the vehicle
    Time order = 0;
    NavEvent event = {};
    Setup setup = {};
    Time frame_time = 0;
    std::function<void(const Estimate&)> answer = {};
  };
  void call(const Call& call, TeamEstimator& estimator);

  std::size_t vehicles_;
  std::vector<Call> calls_;
};

}  // namespace navigation
