// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "sim/world/world.hpp"

namespace experiment {

/// Measures the CPU time of each step in the simulation thread, to 0.1 ms.  Very slow physics (many overlapping
/// bodies) is reported once, with the bodies; a step beyond `limits: step_cpu_s` ends the run.  Neither changes the
/// result of a step.
class StepWatch {
 public:
  explicit StepWatch(const sim::World& world) : world_(world) {}

  /// Encloses World::step().
  void begin();
  void end();
  /// Returns why the run must end: its last step took longer than the world allows.  Considers only the last step.
  std::optional<std::string> beyond_limit() const;
  /// Returns a warning about slow steps; issued again at each tenfold increase.
  std::optional<std::string> take_warning();

 private:
  std::string slow_island() const;

  const sim::World& world_;
  double begun_wall_s_ = 0, last_s_ = 0;
  double mark_cpu_s_ = 0, mark_wall_s_ = -1;  ///< CPU and wall time of the last time when the CPU time was read
  int slow_steps_ = 0;                        ///< consecutive slow steps
  double reported_times_ = 0;                 ///< ratio of CPU time to step length at the last report
  std::optional<double> warn_;                ///< ratio of CPU time to step length of the last step
};

}  // namespace experiment
