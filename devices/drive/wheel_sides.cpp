// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/wheel_sides.hpp"

#include <algorithm>
#include <cmath>

#include "devices/drive/wheel_geometry.hpp"
#include "devices/joint/joint_of_device.hpp"
#include "sim/config/message_text.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace devices {

namespace {

/// Returns 1 when a joint counts how `turned` moves, -1 when it counts how its other body moves on that one.  Without
/// `turned`: of the body that is not the first one of the vehicle; 0: of neither.
double sense_of(const sim::JointConfig& joint, const sim::VehicleConfig& vehicle, const sim::BodyConfig* turned) {
  if (joint.bodies.size() != 2) return 0;
  if (joint.bodies[1] == "world") return 1;
  if (turned != nullptr) return turned->name == joint.bodies[1] ? 1 : -1;
  const std::string& carrier = vehicle.bodies.front().name;
  if (joint.bodies[0] == carrier) return 1;
  return joint.bodies[1] == carrier ? -1 : 0;
}

std::string axis_text(const sim::JointConfig& joint, const sim::Vector3d& axis_V) {
  const auto rounded = [](double value) { return sim::number_text(std::round(value * 1000) / 1000 + 0.0); };
  return "axis [" + rounded(axis_V.x()) + ", " + rounded(axis_V.y()) + ", " + rounded(axis_V.z()) + "] of '" +
         joint.bodies[1] + "' on '" + joint.bodies[0] + "'";
}

void warn_of_joint(const sim::DeviceContext& context, const sim::JointConfig& joint, const std::string& text) {
  context.host.warnings.building().warn(joint.place,
                                        "vehicle '" + context.vehicle.name() + "': joint '" + joint.name + "'", text);
}

}  // namespace

void warn_of_backward_wheels(const sim::DeviceContext& context, const std::vector<std::string>& joints) {
  const sim::VehicleConfig& vehicle = context.vehicle.config();
  for (const std::string& name : joints) {
    const sim::JointConfig& joint = joint_config(context.vehicle, name);
    const WheelGeometry wheel = wheel_geometry(vehicle, name);
    // Only axes that mostly point across the vehicle roll it.
    if (std::abs(wheel.axis_V.y()) < std::max(std::abs(wheel.axis_V.x()), std::abs(wheel.axis_V.z()))) continue;
    if (sense_of(joint, vehicle, wheel.body) * wheel.axis_V.y() < 0)
      warn_of_joint(context, joint,
                    "its wheel turns backwards at positive speed (" + axis_text(joint, wheel.axis_V) +
                        "): a drive needs a wheel that turns positively about +y on its carrier");
  }
}

void warn_of_backward_steering(const sim::DeviceContext& context, const std::vector<std::string>& joints) {
  const sim::VehicleConfig& vehicle = context.vehicle.config();
  for (const std::string& name : joints) {
    const sim::JointConfig& joint = joint_config(context.vehicle, name);
    const sim::Vector3d axis_V = joint.axis1.axis.normalized();
    // An axis that lies nearly flat does not steer, and is reported elsewhere.
    if (std::abs(axis_V.z()) < 0.5) continue;
    const sim::BodyConfig* wheel = joint.type == sim::JointType::hinge2 ? wheel_geometry(vehicle, name).body : nullptr;
    if (sense_of(joint, vehicle, wheel) * axis_V.z() < 0)
      warn_of_joint(context, joint,
                    "it steers to the right at positive angles (" + axis_text(joint, axis_V) +
                        "): a drive needs one that turns positively about +z, to the left");
  }
}

void warn_of_swapped_sides(const sim::DeviceContext& context, const JointsOfKey& left, const JointsOfKey& right) {
  const sim::VehicleConfig& vehicle = context.vehicle.config();
  const auto y_m_of = [&](const std::string& joint) { return wheel_geometry(vehicle, joint).center_V_m.y(); };
  // The middle between the outermost wheels.
  std::vector<double> all_m;
  for (const JointsOfKey* side : {&left, &right})
    for (const std::string& joint : side->joints) all_m.push_back(y_m_of(joint));
  const auto [low, high] = std::minmax_element(all_m.begin(), all_m.end());
  const double middle_m = (*low + *high) / 2, tolerance_m = 0.05 * (*high - *low);
  // Those beyond it.
  std::string wrong;
  const auto look_at = [&](const JointsOfKey& side, double sign, const char* where) {
    for (const std::string& joint : side.joints)
      if (const double y_m = y_m_of(joint); sign * (y_m - middle_m) < -tolerance_m)
        wrong += (wrong.empty() ? "'" : ", '") + std::string(side.key) + "' names '" + joint +
                 "' at y = " + sim::number_text(std::round(y_m * 1000) / 1000) + " m, on the " + where;
  };
  look_at(left, 1, "right");
  look_at(right, -1, "left");
  if (wrong.empty()) return;
  const sim::DeviceConfig& config = context.config;
  context.host.warnings.building().warn(config.source ? sim::place_of(*config.source, left.key) : config.place,
                                        "vehicle '" + context.vehicle.name() + "': device '" + config.name + "'",
                                        wrong + ": left is +y");
}

void warn_of_sides(const sim::DeviceContext& context, const JointsOfKey& left, const JointsOfKey& right) {
  for (const JointsOfKey* side : {&left, &right}) warn_of_backward_wheels(context, side->joints);
  warn_of_swapped_sides(context, left, right);
}

}  // namespace devices
