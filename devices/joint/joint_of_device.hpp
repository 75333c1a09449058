// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/physics/joint.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Throws ConfigError at the place of a device.
[[noreturn]] void refuse(const sim::DeviceContext& context, const std::string& text);

/// Returns a joint by name.  Throws ConfigError when it does not have this axis (0 or 1).
sim::Joint& joint_with_axis(const sim::DeviceContext& context, const std::string& name, int axis);

/// Returns the joint of a wheel, which turns about its last axis.  Throws ConfigError when it is not a hinge or hinge2.
sim::Joint& wheel_joint(const sim::DeviceContext& context, const std::string& name);

/// Returns the configuration of a joint from the vehicle file.
const sim::JointConfig& joint_config(const sim::Vehicle& vehicle, const std::string& name);

}  // namespace devices
