// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/random/random.hpp"
#include "sim/state/state_archive.hpp"

namespace sim {

/// Clock of a vehicle (`clock:` of a vehicle file): its initial offset, and the errors of its free-running oscillator.
/// Frequencies are fractional errors: 1e-6 (1 ppm) gains 3.6 ms in an hour.
struct ClockConfig {
  std::string preset = "perfect";
  double offset_s = 0;               ///< reading minus true time at the start
  double offset_std_s = 0;           ///< of an additional part, drawn once
  double drift_ppm = 0;              ///< constant error of the frequency
  double drift_std_ppm = 0;          ///< of an additional part, drawn once
  double white_fm = 0;               ///< Allan deviation at 1 s due to white frequency noise
  double random_walk_fm = 0;         ///< standard deviation of the frequency's random walk after 1 s, 1 / sqrt(s)
  double flicker_floor = 0;          ///< flat part of the Allan deviation
  double temperature_ppm_per_C = 0;  ///< in water; in air the clock has the reference temperature
  double reference_temperature_C = 20;
  double update_s = 1;         ///< interval at which the random parts advance; in between the error is linear
  double resolution_s = 1e-6;  ///< tick of the reading

  void read(ParamReader& in);
  /// Whether the clock never differs from true time.
  bool perfect() const;
  /// Whether the frequency varies with time.
  bool wanders() const;
};

/// Free-running oscillator.  Its error is x(t) = offset + drift t + w(t); the wander w is due to white frequency noise
/// (a random walk of the phase), a random walk of the frequency and flicker noise (IEEE Std 1139-2008: Allan deviations
/// white_fm / sqrt(tau), random_walk_fm sqrt(tau / 3), flicker_floor).  Flicker noise is the sum of Gauss-Markov
/// processes with correlation times of 1, 10, ... 1e5 s, each with the variance flicker_floor^2 ln(10) / (2 ln 2): the
/// sum of their spectra approximates h / f with 2 ln(2) h = flicker_floor^2.
class Oscillator {
 public:
  /// `name`: name of its random stream, such as `auv1#clock`.
  Oscillator(const ClockConfig& config, std::uint64_t seed, const std::string& name);

  double offset_s() const { return offset_s_; }  ///< at the start
  double drift() const { return drift_; }        ///< constant part of the frequency error, a fraction
  double wander_s() const { return wander_s_; }  ///< w at the end of the last interval
  /// Advances by one interval of `update_s`, exact except for the flicker processes, which are integrated by the
  /// trapezoidal rule.  `temperature_C`: of the surrounding water; empty: not in water.
  void advance(std::optional<double> temperature_C);
  void visit_state(StateArchive& archive);

 private:
  ClockConfig config_;
  Random random_;
  double offset_s_, drift_;
  std::int64_t intervals_ = 0;
  double wander_s_ = 0;
  double walk_ = 0;              ///< random walk of the frequency
  std::vector<double> flicker_;  ///< frequency errors of the processes
};

/// Standard deviation of each process of an oscillator with a flicker floor of 1, and the correlation times.
double flicker_process_std();
const std::vector<double>& flicker_times_s();

}  // namespace sim
