// SPDX-License-Identifier: BSD-3-Clause
#include "motion/gait/leg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "devices/motion/joint_group.hpp"

namespace motion {

namespace {

sim::Vector3d turned_about_y(const sim::Vector3d& v, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * v.x() + s * v.z(), v.y(), c * v.z() - s * v.x()};
}

sim::Vector3d turned_about_x(const sim::Vector3d& v, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {v.x(), c * v.y() - s * v.z(), s * v.y() + c * v.z()};
}

double acos_within(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

/// Reads the legs of a vehicle file.
class LegReader {
 public:
  explicit LegReader(const sim::VehicleConfig& vehicle) : vehicle_(vehicle), servos_(devices::servos_of(vehicle)) {}

  Leg leg(const std::string& name) {
    Leg leg;
    leg.name = name;
    const sim::JointConfig* hip = axis(name + "_swing", 1, leg.swing_sign, leg.swing_limits);
    const sim::JointConfig* flap = axis(name + "_flap", 0, leg.flap_sign, leg.flap_limits);
    const sim::JointConfig* knee = axis(name + "_knee", 1, leg.knee_sign, leg.knee_limits);
    if (hip == nullptr || flap == nullptr || knee == nullptr) return leg;
    leg.hip = hip->anchor_m;
    leg.knee = knee->anchor_m;
    // Inverse kinematics treats the hip as one point with two axes.
    if (!flap->anchor_m.isApprox(hip->anchor_m, 1e-9))
      errors.push_back("leg '" + name + "': the axes of swing and flap must cross");
    read_foot(knee->bodies.at(1), leg);
    limit_flap(leg);
    return leg;
  }

  std::vector<std::string> errors;

 private:
  /// Finds the joint of a servo; its axis must be x (0) or y (1), in any direction.
  const sim::JointConfig* axis(const std::string& servo, int along, double& sign, LegJointLimits& limits) {
    const auto found =
        std::find_if(servos_.begin(), servos_.end(), [&](const auto& one) { return one.device == servo; });
    if (found == servos_.end()) {
      errors.push_back("it has no joint_servo '" + servo + "'");
      return nullptr;
    }
    const devices::JointServo::Params& params = *found->params;
    for (const sim::JointConfig& joint : vehicle_.joints) {
      if (joint.name != params.joint) continue;
      const sim::JointAxisConfig& axis = params.axis == 0 ? joint.axis1 : joint.axis2;
      sign = axis.axis[along] > 0 ? 1 : -1;
      if (std::abs(axis.axis.normalized()[along]) < 1 - 1e-9)
        errors.push_back("the axis of '" + servo + "' must be along " + (along == 0 ? "x" : "y"));
      limits.low = std::max({limits.low, axis.low_stop.value_or(limits.low), params.low.value_or(limits.low)});
      limits.high = std::min({limits.high, axis.high_stop.value_or(limits.high), params.high.value_or(limits.high)});
      limits.max_velocity = params.max_velocity;
      return &joint;
    }
    return nullptr;
  }

  void read_foot(const std::string& body_name, Leg& leg) {
    for (const sim::BodyConfig& body : vehicle_.bodies)
      for (const sim::PartConfig& part : body.parts)
        if (body.name == body_name && part.name == "ball") {
          leg.foot = sim::make_pose(body.position_m, body.rpy_rad) * part.position_m;
          leg.foot_radius_m = part.radius_m;
          return;
        }
    errors.push_back("body '" + body_name + "' has no part 'ball'");
  }

  /// Limits of the flap that depend on the swing: the narrowest holds for all.
  void limit_flap(Leg& leg) {
    for (const sim::DeviceConfig& device : vehicle_.devices) {
      const auto* group = dynamic_cast<const sim::detail::ParamsOf<devices::JointGroup::Params>*>(device.params.get());
      if (group == nullptr) continue;
      for (const devices::JointLimitRow& row : group->params.limits) {
        if (row.joint != leg.name + "_flap") continue;
        if (row.low_rad) leg.flap_limits.low = std::max(leg.flap_limits.low, *row.low_rad);
        if (row.high_rad) leg.flap_limits.high = std::min(leg.flap_limits.high, *row.high_rad);
      }
    }
  }

  const sim::VehicleConfig& vehicle_;
  std::vector<devices::ServoOfVehicle> servos_;
};

}  // namespace

sim::Vector3d Leg::foot_at(const LegPosture& posture) const {
  const sim::Vector3d shank = turned_about_y(foot - knee, knee_sign * posture.knee);
  const sim::Vector3d flapped = turned_about_x(knee - hip + shank, flap_sign * posture.flap);
  return hip + turned_about_y(flapped, swing_sign * posture.swing);
}

LegPosture Leg::posture_at(const sim::Vector3d& foot_V) const {
  const sim::Vector3d desired = foot_V - hip, thigh = knee - hip, shank = foot - knee;
  LegPosture posture;
  // The knee sets the distance from the hip to the foot in the plane of the leg, which is `offset` beside the hip:
  // |thigh + shank turned|^2 = thigh^2 + shank^2 + 2 (a cos + b sin).
  const double offset = thigh.y() + shank.y();
  const double distance2 = std::max(0.0, desired.squaredNorm() - offset * offset);
  const double thigh2 = thigh.x() * thigh.x() + thigh.z() * thigh.z();
  const double shank2 = shank.x() * shank.x() + shank.z() * shank.z();
  const double a = thigh.x() * shank.x() + thigh.z() * shank.z(), b = thigh.x() * shank.z() - thigh.z() * shank.x();
  const double cosine = (distance2 - thigh2 - shank2) / 2 / std::hypot(a, b);
  posture.knee = knee_sign * std::atan2(b, a) + acos_within(cosine);
  // The flap sets how far the foot is aside, as swinging does not change it.
  const sim::Vector3d bent = thigh + turned_about_y(shank, knee_sign * posture.knee);
  const double aside = desired.y() / std::hypot(bent.y(), bent.z());
  posture.flap = flap_sign * (-std::atan2(bent.z(), bent.y()) - acos_within(aside));
  // The swing turns it to where it is to be.
  const sim::Vector3d flapped = turned_about_x(bent, flap_sign * posture.flap);
  const double turn = std::atan2(desired.x(), desired.z()) - std::atan2(flapped.x(), flapped.z());
  posture.swing = swing_sign * std::remainder(turn, 2 * std::numbers::pi);
  posture.reached = std::abs(cosine) <= 1 && std::abs(aside) <= 1;
  return posture;
}

std::vector<Leg> legs_of(const sim::VehicleConfig& vehicle) {
  LegReader reader(vehicle);
  std::vector<Leg> legs;
  for (const char* name : {"lf", "rf", "lh", "rh"}) legs.push_back(reader.leg(name));
  for (std::string& error : reader.errors) error = "vehicle '" + vehicle.vehicle + "': no legs for a gait: " + error;
  if (!reader.errors.empty()) throw sim::ConfigError(reader.errors);
  return legs;
}

}  // namespace motion
