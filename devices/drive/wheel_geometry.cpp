// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/wheel_geometry.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>

#include "sim/base/math.hpp"
#include "sim/config/message_text.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world.hpp"

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

namespace {

/// Height tolerance of supporting points: higher points carry no load, because contacts are hard.
constexpr double level_m = 5e-5;

/// Point that may rest on the ground.
struct Support {
  sim::Vector3d p_V_m = sim::Vector3d::Zero();
  bool driven = false;
  std::string part;  ///< name in messages
};

std::string part_text(const sim::BodyConfig& body, const sim::PartConfig& part) {
  return "'" + body.name + (part.name.empty() ? "" : "/" + part.name) + "'";
}

/// Returns the lowest points of a part: one point of a round shape, the corners of a box; empty for another shape.
std::vector<sim::Vector3d> low_points(const sim::BodyConfig& body, const sim::PartConfig& part) {
  const sim::Pose X_VP = sim::make_pose(body.position_m, body.rpy_rad) * sim::make_pose(part.position_m, part.rpy_rad);
  const sim::Vector3d down = -part.radius_m * sim::Vector3d::UnitZ();
  switch (part.shape) {
    case sim::PartShape::sphere:
      return {X_VP.translation() + down};
    case sim::PartShape::capsule:
    case sim::PartShape::cylinder: {
      // Horizontal axis: the line below it.
      const sim::Vector3d along = X_VP.linear().col(2);
      if (std::abs(along.z()) < 1e-3) return {X_VP.translation() + down};
      // Inclined axis: the lower end.
      const sim::Vector3d end = X_VP.translation() - std::copysign(part.length_m / 2, along.z()) * along;
      if (part.shape == sim::PartShape::capsule) return {end + down};
      return {end - part.radius_m * std::sqrt(1 - along.z() * along.z()) * sim::Vector3d::UnitZ()};
    }
    case sim::PartShape::box: {
      std::vector<sim::Vector3d> corners;
      for (int i = 0; i < 8; ++i) {
        const sim::Vector3d corner(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
        corners.push_back(X_VP * corner.cwiseProduct(part.size_m).eval());
      }
      return corners;
    }
    case sim::PartShape::plane:
    case sim::PartShape::mesh:
    case sim::PartShape::terrain:
      break;
  }
  return {};
}

/// Returns whether a part collides with ordinary ground.
bool meets_ground(const sim::PartConfig& part) {
  return part.collides_with.empty() ||
         std::find(part.collides_with.begin(), part.collides_with.end(), "solid") != part.collides_with.end();
}

/// Returns whether a vehicle has a suspension or other compliance between its wheels.
bool gives(const sim::VehicleConfig& vehicle) {
  return std::any_of(vehicle.joints.begin(), vehicle.joints.end(), [&](const sim::JointConfig& joint) {
    if (joint.type == sim::JointType::fixed) return false;
    if (!sim::joint_info(joint.type).carries_a_wheel) return true;
    if (joint.axis1.suspension_erp || joint.axis1.suspension_cfm) return true;
    return wheel_geometry(vehicle, joint.name).body == nullptr;  // a rocker, or an arm that may rest on the ground
  });
}

bool is_soft(const sim::WorldConfig& world) {
  return std::any_of(world.contacts.begin(), world.contacts.end(),
                     [](const sim::ContactConfig& contact) { return contact.soft_cfm.value_or(0) > 0; });
}

/// Returns the points as low as the driven wheels, or lower; none when the wheels are not round or not level.
std::optional<std::vector<Support>> supports_of(const sim::VehicleConfig& vehicle,
                                                const std::vector<std::string>& driven_joints) {
  std::vector<const sim::BodyConfig*> driven;
  double ground_m = std::numeric_limits<double>::infinity(), highest_m = -ground_m;
  for (const std::string& joint : driven_joints) {
    const WheelGeometry wheel = wheel_geometry(vehicle, joint);
    if (wheel.body == nullptr || std::abs(wheel.axis_V.z()) > 1e-3) return std::nullopt;
    driven.push_back(wheel.body);
    ground_m = std::min(ground_m, wheel.center_V_m.z() - *wheel.radius_m);
    highest_m = std::max(highest_m, wheel.center_V_m.z() - *wheel.radius_m);
  }
  if (highest_m - ground_m > level_m) return std::nullopt;
  std::vector<Support> supports;
  for (const sim::BodyConfig& body : vehicle.bodies) {
    const bool is_driven = std::find(driven.begin(), driven.end(), &body) != driven.end();
    for (const sim::PartConfig& part : body.parts)
      for (const sim::Vector3d& p_V_m : low_points(body, part))
        if (meets_ground(part) && p_V_m.z() <= highest_m + level_m)
          supports.push_back({p_V_m, is_driven, part_text(body, part)});
  }
  return supports;
}

/// Returns whether a + b x + c y can be 1 at the driven points and 0 at the others.
bool weight_is_determined(const std::vector<Support>& supports) {
  const auto count = static_cast<Eigen::Index>(supports.size());
  Eigen::MatrixX3d places(count, 3);
  Eigen::VectorXd left(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Support& support = supports[static_cast<std::size_t>(i)];
    places.row(i) << 1, support.p_V_m.x(), support.p_V_m.y();
    left[i] = support.driven ? 1 : 0;
  }
  return (left - places * sim::least_squares(places, left)).cwiseAbs().maxCoeff() < 0.02;
}

}  // namespace

void warn_of_shared_weight(const sim::DeviceContext& context, const std::vector<std::string>& driven_joints) {
  const sim::WorldConfig& world = context.world.config();
  const sim::VehicleConfig& vehicle = context.vehicle.config();
  // Soft contacts share the weight by their stiffness, so that it is determined.
  if (world.physics.gravity_mps2 == 0 || is_soft(world) || gives(vehicle)) return;
  const auto supports = supports_of(vehicle, driven_joints);
  if (!supports || weight_is_determined(*supports)) return;
  std::string others;
  for (const Support& support : *supports)
    if (!support.driven && others.find(support.part) == std::string::npos)
      others += (others.empty() ? "" : ", ") + support.part;
  context.host.warnings.building().warn(
      context.config.place, "vehicle '" + context.vehicle.name() + "': device '" + context.config.name + "'",
      "how much weight its driven wheels carry is undetermined: " + others + " stand as low as they (" +
          std::to_string(supports->size()) +
          " points of one rigid vehicle), and may take it all; raise one of them by a millimeter");
}

}  // namespace devices
