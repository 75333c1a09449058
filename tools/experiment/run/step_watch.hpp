// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "sim/world/world.hpp"

namespace tools {

/// Measures the CPU time of each step in the thread that simulates.  Very slow physics (many overlapping bodies) is
/// reported once, with the bodies; a step beyond `limits: step_cpu_s` ends the run.  What a step
/// comes to does not depend on either.
class StepWatch {
 public:
  explicit StepWatch(const sim::World& world) : world_(world) {}

  /// Around World::step().
  void begin();
  void end();
  /// Why the run must end: its last step took longer than the world allows.  Looks at the last step only.
  std::optional<std::string> beyond_limit() const;
  /// What people should know of slow steps; each time 10 times as slow as before.
  std::optional<std::string> take_warning();

 private:
  std::string slow_island() const;

  const sim::World& world_;
  double begun_s_ = 0, last_s_ = 0;
  int slow_steps_ = 0;          ///< one after the other
  double reported_times_ = 0;   ///< how many times its length a step took when that was said
  std::optional<double> warn_;  ///< how many times its length the last step took
};

}  // namespace tools
