// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/physics/joint.hpp"
#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Throws ConfigError at the place of a device.
[[noreturn]] void refuse(const sim::DeviceContext& context, const std::string& text);

/// The joint of a name; ConfigError where it has no such axis (0 or 1).
sim::Joint& joint_with_axis(const sim::DeviceContext& context, const std::string& name, int axis);

/// The joint of a wheel, which turns about the last axis; ConfigError where it is not a hinge or hinge2.
sim::Joint& wheel_joint(const sim::DeviceContext& context, const std::string& name);

/// How the vehicle file describes a joint.
const sim::JointConfig& joint_config(const sim::Vehicle& vehicle, const std::string& name);

}  // namespace devices
