// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/vehicle/device_context.hpp"

namespace devices {

/// Joints that a key of a device names.
struct JointsOfKey {
  const char* key;
  std::vector<std::string> joints;
};

/// Warns of each wheel that turns backwards at a positive speed of its joint: forward is a positive turn of the wheel
/// about +y of the vehicle.  Not of wheels whose axis is nearer to x or z, and not where it is unknown which body of
/// the joint is the wheel.
void warn_of_backward_wheels(const sim::DeviceContext& context, const std::vector<std::string>& joints);

/// Warns of each joint whose second body, or the one that is not the vehicle's first, turns to the right at positive
/// angles of its first axis.
void warn_of_backward_steering(const sim::DeviceContext& context, const std::vector<std::string>& joints);

/// Warns of joints on the other side of the vehicle than their key says: left is +y, from the middle between the
/// outermost ones.
void warn_of_swapped_sides(const sim::DeviceContext& context, const JointsOfKey& left, const JointsOfKey& right);

/// All that can be wrong with the wheels of a drive, or an odometry, with a left and a right side.
void warn_of_sides(const sim::DeviceContext& context, const JointsOfKey& left, const JointsOfKey& right);

}  // namespace devices
