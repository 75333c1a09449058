// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "sim/base/math.hpp"

namespace viewer {

/// Estimated pose of a vehicle, from a message of one of its programs.
struct VehicleEstimate {
  std::int64_t utime = 0;  ///< at which it was valid, by the clock of the vehicle
  sim::Vector3d position_m = sim::Vector3d::Zero();
  sim::Quaterniond orientation = sim::Quaterniond::Identity();  ///< vehicle to world; of shoal.estimate_t the heading
  std::optional<Eigen::Matrix3d> covariance_m2;                 ///< of the position; unset: not known
};

/// Reads shoal.estimate_t on any channel, and shoal.pose_t on `VEHICLE.estimate`: on others a pose may be anything,
/// such as a goal.  Returns std::nullopt for other messages, and for a position that is not finite.  Throws
/// shoal::MessageError when the message is damaged.
std::optional<VehicleEstimate> read_estimate(std::string_view channel, std::span<const std::byte> payload);

}  // namespace viewer
