// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <memory>
#include <string>

#include "sim/base/time.hpp"
#include "sim/clock/oscillator.hpp"

namespace sim {

/// How a receiver of satellites steers a clock.
struct DisciplineParams {
  double time_constant_s = 20;  ///< of the loop, which is critically damped
  double step_above_s = 1e-3;   ///< a larger error is taken out at once
  double pps_std_s = 50e-9;     ///< jitter of the pulse that it compares with
  double interval_s = 1;        ///< between two fixes
};

/// The clock of a vehicle, by which its devices stamp their reports.  Made without arguments it is perfect: it reads
/// the true time, and costs nothing.
///
/// Reading and true time are times since the start of the run; the error is reading minus true time.  A reading never
/// decreases while true time advances, except for a step by the discipline.
class VehicleClock {
 public:
  VehicleClock();
  /// Perfect too when the configuration is.  `start`: when its offset holds and its drift begins.
  VehicleClock(const ClockConfig& config, std::uint64_t seed, const std::string& vehicle, Time start);
  ~VehicleClock();
  VehicleClock(VehicleClock&&) noexcept;
  VehicleClock& operator=(VehicleClock&&) noexcept;

  bool perfect() const { return !state_; }
  /// What it shows at a true time: exact for the last `memory` and for 2 s to come, unless it is steered in that time.
  Time reading(Time at) const;
  /// When it shows a reading: the inverse of reading(), except for rounding.  Where a step of the discipline makes it
  /// show a reading twice, one of the two times; where it skips one, a time near the step.
  Time true_time(Time reading) const;
  /// Reading minus true time, without the rounding to ticks.
  double error_s(Time at) const;
  /// Error of its rate now (1e-6: it gains 1 us in a second), a steering slew included.
  double rate_error() const;

  /// Continues to the time of the world.
  void advance_to(Time now, std::optional<double> water_temperature_C);
  /// advance_to() will look at the temperature of the water.
  bool wants_temperature(Time now) const;

  /// A fix came with a pulse on the second: what the clock showed at `now` minus the time of the pulse, jitter
  /// included. What it corrects holds for readings after `now`, so that everything that is stamped in one step agrees.
  void discipline(Time now, double measured_error_s, const DisciplineParams& params);
  /// The receiver disciplined it within the last three intervals of fixes.
  bool disciplined(Time now) const;
  /// Since the last fix that disciplined it; negative: there was none.
  double since_fix_s(Time now) const;
  /// Standard deviation of its error as a program could work it out from its data sheet and the time since the last
  /// fix; see docs/models/clocks.md for the equation.  0 of a perfect clock.
  double estimated_std_s(Time now) const;

  void visit_state(StateArchive& archive);
  /// It was advanced to this time last, or is perfect.
  bool is_stopped_at(Time now) const;

  static constexpr Time memory{60'000'000};

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sim
