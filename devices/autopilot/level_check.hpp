// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "devices/autopilot/autopilot_actuators.hpp"

namespace devices {

/// Compares the gains that hold roll and pitch with the Munk moment of the craft: warns where they are too weak for the
/// speed that its thrusters reach, and notes the speed up to which they hold it level.  A craft with fins or a
/// waterline is not checked: these right it.
void check_level(AutopilotActuators& actuators, const HoldGains& attitude, const sim::DeviceContext& context);

}  // namespace devices
