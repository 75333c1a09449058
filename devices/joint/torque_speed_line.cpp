// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/torque_speed_line.hpp"

#include <algorithm>

namespace devices {

void TorqueSpeedLine::read(sim::ParamReader& in) {
  in.read(
      "stall_effort", stall_effort, sim::above(0),
      "effort of the motor at standstill, N m or N, which decreases linearly with the velocity; unset: max_effort at "
      "any velocity");
  in.read("no_load_velocity", no_load_velocity, sim::above(0), "velocity without load, at which the effort is 0");
  // A line needs two points.
  if (in.describing() || stall_effort.has_value() == no_load_velocity.has_value()) return;
  if (stall_effort)
    in.error("stall_effort", "'stall_effort' needs 'no_load_velocity'");
  else
    in.error("no_load_velocity", "'no_load_velocity' needs 'stall_effort'");
}

// With slope b = stall_effort / no_load_velocity, the effort F = b (no_load_velocity - w) at the velocity w at the end
// of the step, w = velocity + step mobility (F - friction - load).  The load is that of the step before: there the
// efforts gave velocity - velocity_before = step mobility (effort_before - load).  Both equations for F give the
// implicit step, which neither oscillates nor overshoots, however light the joint is.
double TorqueSpeedLine::max_effort(const Motion& motion, double share, double step_s) const {
  const double stall = share * *stall_effort, slope = stall / *no_load_velocity;
  const double gain = slope * step_s * motion.mobility;
  const double expected = 2 * motion.velocity - motion.velocity_before;
  const double effort = (stall - slope * expected + gain * (motion.effort_before + motion.friction)) / (1 + gain);
  // Not beyond the effort at the lowest velocity that is expected.
  return std::clamp(effort, 0.0, stall - slope * std::min({0.0, motion.velocity, expected}));
}

}  // namespace devices
