// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "sim/config/param_reader.hpp"
#include "sim/physics/joint.hpp"

namespace devices {

/// Power that the motor of an axis draws from the battery, by the model of a DC motor: mechanical power over
/// efficiency, plus the heat of its winding, which is proportional to the square of the effort, even at standstill
/// (Krause et al., Analysis of Electric Machinery and Drive Systems, 3rd ed., 2013: P = effort * velocity + R i^2,
/// effort ~ i). Braking recovers no energy.
struct MotorPower {
  double efficiency = 0.8;
  double holding_W = 0;  ///< heat at maximum effort

  void read(sim::ParamReader& in) {
    in.read("efficiency", efficiency, sim::above_to(0, 1), "mechanical power over electrical power of a motor");
    in.read("holding_W", holding_W, sim::at_least(0),
            "heat of a motor at its largest effort; less by the square of the effort");
  }
  /// Returns the power of the motor of an axis in the physics.  The load of the joint must be measured.
  double of_motor(const sim::Joint& joint, int axis, double max_effort) const {
    // Limit the effort: a stop may push harder than the motor, without drawing power.
    const double limit = joint.motor_max_force(axis);
    return of(std::clamp(joint.effort(axis), -limit, limit), joint.velocity(axis), max_effort);
  }
  double of(double effort, double velocity, double max_effort) const {
    const double share = max_effort > 0 ? effort / max_effort : 0;
    return std::max(effort * velocity, 0.0) / efficiency + holding_W * share * share;
  }
};

}  // namespace devices
