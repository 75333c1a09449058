// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/wheel_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sim/config/message_text.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace devices {

namespace {

const sim::JointConfig& joint_named(const sim::VehicleConfig& vehicle, const std::string& name) {
  for (const sim::JointConfig& joint : vehicle.joints)
    if (joint.name == name) return joint;
  throw std::out_of_range(name);
}

const sim::BodyConfig* body_named(const sim::VehicleConfig& vehicle, const std::string& name) {
  for (const sim::BodyConfig& body : vehicle.bodies)
    if (body.name == name) return &body;
  return nullptr;
}

/// Returns whether a part has rotational symmetry about the axis.
bool is_round(const sim::PartConfig& part, const sim::Matrix3d& R_VB, const sim::Vector3d& axis_V) {
  if (part.shape == sim::PartShape::sphere) return true;
  if (!sim::shape_info(part.shape).round) return false;
  const sim::Matrix3d R_BP = sim::make_pose(part.position_m, part.rpy_rad).linear();
  return std::abs((R_VB * R_BP).col(2).dot(axis_V)) > 0.999;
}

/// Returns whether all parts of a body are round, so that it is a wheel and not its carrier.
bool is_wheel(const sim::BodyConfig& body, const sim::Vector3d& axis_V) {
  const sim::Matrix3d R_VB = sim::make_pose(body.position_m, body.rpy_rad).linear();
  return !body.parts.empty() && std::all_of(body.parts.begin(), body.parts.end(),
                                            [&](const sim::PartConfig& part) { return is_round(part, R_VB, axis_V); });
}

sim::Vector3d mean_place(const sim::VehicleConfig& vehicle, const std::vector<std::string>& joints) {
  sim::Vector3d sum_m = sim::Vector3d::Zero();
  for (const std::string& joint : joints) sum_m += wheel_geometry(vehicle, joint).center_V_m;
  return sum_m / static_cast<double>(joints.size());
}

}  // namespace

WheelGeometry wheel_geometry(const sim::VehicleConfig& vehicle, const std::string& name) {
  const sim::JointConfig& joint = joint_named(vehicle, name);
  WheelGeometry wheel;
  wheel.center_V_m = joint.anchor_m;
  wheel.axis_V = (joint.type == sim::JointType::hinge2 ? joint.axis2 : joint.axis1).axis.normalized();
  // The wheel is usually the second body of a joint; a joint may name it first.
  for (const std::size_t end : {1u, 0u}) {
    if (end >= joint.bodies.size()) continue;
    const sim::BodyConfig* body = body_named(vehicle, joint.bodies[end]);
    if (body == nullptr || !is_wheel(*body, wheel.axis_V)) continue;
    const auto largest = std::max_element(body->parts.begin(), body->parts.end(),
                                          [](const auto& a, const auto& b) { return a.radius_m < b.radius_m; });
    wheel.body = body;
    wheel.center_V_m = sim::make_pose(body->position_m, body->rpy_rad) * largest->position_m;
    wheel.radius_m = largest->radius_m;
    break;
  }
  return wheel;
}

double track_m_of(const sim::VehicleConfig& vehicle, const std::vector<std::string>& left_joints,
                  const std::vector<std::string>& right_joints) {
  const sim::Vector3d across_m = mean_place(vehicle, left_joints) - mean_place(vehicle, right_joints);
  return std::abs(across_m.dot(wheel_geometry(vehicle, left_joints.front()).axis_V));
}

double scrubbing_track_m_of(const sim::VehicleConfig& vehicle, const std::vector<std::string>& left_joints,
                            const std::vector<std::string>& right_joints) {
  const double track_m = track_m_of(vehicle, left_joints, right_joints);
  const double middle_m = (mean_place(vehicle, left_joints) + mean_place(vehicle, right_joints)).x() / 2;
  double squares_m2 = 0;
  for (const std::vector<std::string>* side : {&left_joints, &right_joints})
    for (const std::string& joint : *side)
      squares_m2 += std::pow(wheel_geometry(vehicle, joint).center_V_m.x() - middle_m, 2);
  const double a2_m2 = squares_m2 / static_cast<double>(left_joints.size() + right_joints.size());
  return track_m > 0 ? track_m + 4 * a2_m2 / track_m : 0;
}

std::optional<double> wheel_radius_m_of(const sim::VehicleConfig& vehicle, const std::vector<std::string>& joints) {
  double sum_m = 0;
  for (const std::string& joint : joints) {
    const std::optional<double> radius_m = wheel_geometry(vehicle, joint).radius_m;
    if (!radius_m) return std::nullopt;
    sum_m += *radius_m;
  }
  return sum_m / static_cast<double>(joints.size());
}

std::optional<double> wheelbase_m_of(const sim::VehicleConfig& vehicle,
                                     const std::vector<std::string>& steered_joints) {
  double rear_m = std::numeric_limits<double>::infinity();
  for (const sim::JointConfig& joint : vehicle.joints) {
    const bool steered = std::find(steered_joints.begin(), steered_joints.end(), joint.name) != steered_joints.end();
    if (steered || !sim::joint_info(joint.type).carries_a_wheel) continue;
    const WheelGeometry wheel = wheel_geometry(vehicle, joint.name);
    if (wheel.rolls()) rear_m = std::min(rear_m, wheel.center_V_m.x());
  }
  const double front_m = mean_place(vehicle, steered_joints).x();
  if (rear_m < front_m) return front_m - rear_m;
  return std::nullopt;
}

void check_length(const sim::DeviceContext& context, const LengthOfDevice& length, const AllowedRatio& allowed,
                  const std::string& effect, double (*factor)(double ratio)) {
  // A length that was not given is taken from the joints, and cannot contradict them.
  if (!length.given_m || !length.real_m || !(*length.real_m > 0)) return;
  const double ratio = *length.given_m / *length.real_m;
  if (ratio >= allowed.low && ratio <= allowed.high) return;
  const auto rounded = [](double value) { return sim::number_text(std::round(value * 1000) / 1000); };
  std::string result = effect;
  if (const std::size_t at = result.find("{}"); at != std::string::npos) result.replace(at, 2, rounded(factor(ratio)));
  const sim::DeviceConfig& config = context.config;
  context.host.warnings.building().warn(config.source ? sim::place_of(*config.source, length.key) : config.place,
                                        "vehicle '" + context.vehicle.name() + "': device '" + config.name + "'",
                                        "'" + std::string(length.key) + "' is " + rounded(*length.given_m) +
                                            ", but its joints and wheels make it " + rounded(*length.real_m) + ": " +
                                            result);
}

}  // namespace devices
