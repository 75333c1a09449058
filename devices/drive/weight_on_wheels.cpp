// SPDX-License-Identifier: BSD-3-Clause
#include "devices/drive/weight_on_wheels.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "devices/drive/wheel_geometry.hpp"
#include "sim/base/math.hpp"
#include "sim/config/message_text.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world.hpp"

namespace devices {

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
