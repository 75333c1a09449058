// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/estimates/vehicle_estimate.hpp"

#include <cmath>

#include "shoal/estimate_t.hpp"
#include "shoal/message_codec.hpp"
#include "shoal/pose_t.hpp"

namespace viewer {

namespace {

VehicleEstimate from_estimate(const shoal::estimate_t& message) {
  VehicleEstimate estimate{message.utime, sim::Vector3d(message.position_m), sim::Quaterniond::Identity(),
                           Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(message.covariance_m2)};
  if (std::isfinite(message.yaw_rad)) estimate.orientation = Eigen::AngleAxisd(message.yaw_rad, sim::Vector3d::UnitZ());
  return estimate;
}

VehicleEstimate from_pose(const shoal::pose_t& message) {
  VehicleEstimate estimate{message.utime, sim::Vector3d(message.pos), sim::Quaterniond::Identity(), std::nullopt};
  const double* const q = message.orientation;
  const sim::Quaterniond orientation(q[0], q[1], q[2], q[3]);
  if (orientation.coeffs().allFinite() && orientation.norm() > 0) estimate.orientation = orientation.normalized();
  return estimate;
}

}  // namespace

std::optional<VehicleEstimate> read_estimate(std::string_view channel, std::span<const std::byte> payload) {
  constexpr std::size_t fingerprint_bytes = 8;
  if (payload.size() < fingerprint_bytes) return std::nullopt;
  std::optional<VehicleEstimate> estimate;
  if (shoal::fingerprint(payload) == shoal::fingerprint_of<shoal::estimate_t>())
    estimate = from_estimate(shoal::decode<shoal::estimate_t>(payload, shoal::Finite::any));
  else if (channel.ends_with(".estimate") && shoal::fingerprint(payload) == shoal::fingerprint_of<shoal::pose_t>())
    estimate = from_pose(shoal::decode<shoal::pose_t>(payload, shoal::Finite::any));
  if (estimate && !estimate->position_m.allFinite()) return std::nullopt;
  return estimate;
}

}  // namespace viewer
