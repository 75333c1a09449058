// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <memory>
#include <string>

#include "sim/base/time.hpp"
#include "sim/clock/oscillator.hpp"

namespace sim {

/// Parameters of the steering of a clock by a GNSS receiver.
struct DisciplineParams {
  double time_constant_s = 20;  ///< of the loop, which is critically damped
  double step_above_s = 1e-3;   ///< a larger error is corrected by a step
  double pps_std_s = 50e-9;     ///< jitter of the pulse per second
  double interval_s = 1;        ///< between two fixes
};

/// Clock of a vehicle, with which its devices stamp their messages.  A default-constructed clock is perfect: it shows
/// true time at no cost.
///
/// Reading and true time are times since the start of the run; the error is reading minus true time.  A reading never
/// decreases while true time advances, except for a step by the discipline.
class VehicleClock {
 public:
  VehicleClock();
  /// Makes a clock; perfect when the configuration is.  `start`: time at which its offset holds and its drift starts.
  VehicleClock(const ClockConfig& config, std::uint64_t seed, const std::string& vehicle, Time start);
  ~VehicleClock();
  VehicleClock(VehicleClock&&) noexcept;
  VehicleClock& operator=(VehicleClock&&) noexcept;

  bool perfect() const { return !state_; }
  /// Reading at a true time: exact for the last `memory` and for the next 2 s, unless it is steered in that time.
  Time reading(Time at) const;
  /// True time of a reading: the inverse of reading(), except for rounding.  Where a step of the discipline repeats a
  /// reading, one of the two times; where it skips one, a time near the step.
  Time true_time(Time reading) const;
  /// Reading minus true time, without the rounding to ticks.
  double error_s(Time at) const;
  /// Present error of the rate (1e-6: it gains 1 us in a second), including a steering slew.
  double rate_error(Time now) const;

  /// Advances to the time of the world.
  void advance_to(Time now, std::optional<double> water_temperature_C);
  /// Time before which advance_to() would change nothing but the time of the clock, which advance_time_to() sets.
  Time next_advance() const;
  /// Sets the time of the clock, before its state is visited.
  void advance_time_to(Time now);
  /// Whether advance_to() will use the temperature of the water.
  bool wants_temperature(Time now) const;

  /// Steers the clock by a fix with a pulse per second: the reading at `now` minus the time of the pulse, including
  /// jitter.  The correction applies to readings after `now`, so that all stamps of one step agree.
  void discipline(Time now, double measured_error_s, const DisciplineParams& params);
  /// Whether a fix steered the clock within the last three intervals of fixes.
  bool disciplined(Time now) const;
  /// Time since the last fix that steered the clock; negative: none.
  double since_fix_s(Time now) const;
  /// Standard deviation of the error, as a program could compute it from the data sheet and the time since the last
  /// fix; see docs/models/clocks.md for the equation.  0 for a perfect clock.
  double estimated_std_s(Time now) const;

  void visit_state(StateArchive& archive);
  /// Whether the clock was last advanced to this time, or is perfect.
  bool is_stopped_at(Time now) const;

  static constexpr Time memory{60'000'000};

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sim
