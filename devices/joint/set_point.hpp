// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/state/state_archive.hpp"

namespace devices {

/// Set point with limited velocity and acceleration that comes to rest exactly at its target.
class SetPoint {
 public:
  double position = 0;
  double velocity = 0;

  struct Limits {
    double velocity;
    double acceleration;  ///< may be infinite
  };
  void visit_state(sim::StateArchive& archive) { archive(position, velocity); }
  /// Runs one step towards a position.
  void approach(double target, const Limits& limits, double step_s);
  /// Runs one step at a velocity, within the position limits.
  void run(double target_velocity, double low, double high, const Limits& limits, double step_s);

 private:
  void advance(double desired_velocity, const Limits& limits, double step_s);
};

}  // namespace devices
