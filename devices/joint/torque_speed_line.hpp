// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "sim/config/param_reader.hpp"

namespace devices {

/// Linear torque-speed line of a DC motor at full voltage: effort = stall_effort (1 - velocity / no_load_velocity).
/// Beyond the no-load velocity it is 0.
struct TorqueSpeedLine {
  std::optional<double> stall_effort;      ///< N m or N; unset: no line
  std::optional<double> no_load_velocity;  ///< rad/s or m/s; set with stall_effort

  /// Motion of the joint at the start of a step, in the direction of the effort.
  struct Motion {
    double velocity = 0;
    double velocity_before = 0;  ///< one step earlier
    double effort_before = 0;    ///< all efforts on the joint in the step before
    double friction = 0;         ///< effort of friction in this step, positive against the motor
    double mobility = 0;         ///< of the joint, or more
  };

  void read(sim::ParamReader& in);
  bool has() const { return stall_effort.has_value(); }
  /// Returns the largest effort of a step, at the velocity at its end, never negative.  `share`: of the stall effort.
  double max_effort(const Motion& motion, double share, double step_s) const;
};

}  // namespace devices
