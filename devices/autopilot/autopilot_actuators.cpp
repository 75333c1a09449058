// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/autopilot_actuators.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "devices/autopilot/autopilot_control.hpp"
#include "devices/joint/joint_of_device.hpp"
#include "devices/marine/fin.hpp"
#include "shoal/actuator_command_t.hpp"
#include "shoal/message_codec.hpp"
#include "sim/base/math.hpp"
#include "sim/vehicle/mounted_device.hpp"
#include "sim/world/world.hpp"

namespace devices {

namespace {

// Density of water for the limits of thrust and lift, which need not be exact.
constexpr double plan_density_kgpm3 = 1025;

/// Returns the configuration of a device of the vehicle.  The device may follow the autopilot in the file, so that it
/// is not constructed yet.
template <typename Params>
std::pair<const sim::DeviceConfig*, const Params*> described(const sim::DeviceContext& context, const char* key,
                                                             const std::string& name, const char* type) {
  for (const sim::DeviceConfig& device : context.vehicle.config().devices) {
    if (device.name != name || device.type != type) continue;
    const auto& bodies = context.vehicle.config().bodies;
    const auto body_of = [&](const sim::DeviceConfig& config) {
      return config.body.empty() ? bodies.front().name : config.body;
    };
    if (body_of(device) != body_of(context.config))
      refuse(context, std::string("'") + key + "': " + type + " '" + name + "' is not on the body of the autopilot");
    return {&device, &static_cast<const sim::detail::ParamsOf<Params>&>(*device.params).params};
  }
  refuse(context, std::string("'") + key + "' names no " + type + " '" + name + "'");
}

/// Returns mass and moments of inertia about the origin of the body, including added mass.
Wrench mass_of(const sim::DeviceContext& context) {
  const sim::Body& body = context.body;
  const sim::Vector3d r = body.p_BC();
  Wrench mass;
  mass.head<3>().setConstant(body.mass_kg());
  mass.tail<3>() =
      body.inertia_C_B().diagonal() + body.mass_kg() * (sim::Vector3d::Constant(r.squaredNorm()) - r.cwiseAbs2());
  if (const sim::HydrodynamicsConfig* water = hydrodynamics_of(context)) mass += water->added_mass.diagonal();
  return mass;
}

/// Reports an error when another autopilot drives one of the same actuators.
void refuse_two_masters(const AutopilotParams& params, const sim::DeviceContext& context) {
  const auto driven_by = [](const AutopilotParams& autopilot) {
    std::vector<std::string> names = autopilot.thrusters;
    names.insert(names.end(), autopilot.fins.begin(), autopilot.fins.end());
    if (!autopilot.helm.empty()) names.push_back(autopilot.helm);
    return names;
  };
  const std::vector<std::string> own = driven_by(params);
  for (const sim::DeviceConfig& device : context.vehicle.config().devices) {
    if (device.type != "autopilot" || device.name == context.config.name) continue;
    const auto& other = static_cast<const sim::detail::ParamsOf<AutopilotParams>&>(*device.params).params;
    for (const std::string& name : driven_by(other))
      if (std::find(own.begin(), own.end(), name) != own.end())
        refuse(context, "'" + name + "' is already driven by autopilot '" + device.name + "'");
  }
}

}  // namespace

const sim::HydrodynamicsConfig* hydrodynamics_of(const sim::DeviceContext& context) {
  for (const sim::BodyConfig& config : context.vehicle.config().bodies)
    if (context.body.name() == context.vehicle.name() + "/" + config.name && config.hydrodynamics)
      return &*config.hydrodynamics;
  return nullptr;
}

AutopilotActuators::AutopilotActuators(const AutopilotParams& params, const sim::DeviceContext& context)
    : vehicle_(context.vehicle), epoch_us_(context.world.epoch_us()), mass_(mass_of(context)) {
  refuse_two_masters(params, context);
  add_thrusters(params, context);
  add_fins(params, context);
}

void AutopilotActuators::add_thrusters(const AutopilotParams& params, const sim::DeviceContext& context) {
  // Pose, limits and weight of each thruster.
  std::vector<ThrusterPlace> places;
  for (std::size_t i = 0; i < params.thrusters.size(); ++i) {
    const auto [config, thruster] = described<Thruster::Params>(context, "thrusters", params.thrusters[i], "thruster");
    ThrusterPlace place;
    place.X_ST = config->X_BS();
    const ThrusterCommand curve(*thruster);
    place.max_N = curve.max_N(plan_density_kgpm3);
    place.min_N = curve.min_N(plan_density_kgpm3);
    if (!params.thruster_weights.empty()) place.weight = params.thruster_weights[i];
    places.push_back(place);
    propellers_.push_back({{params.thrusters[i]}, curve, place.X_ST.linear().col(0)});
  }
  if (places.empty()) return;
  // Indices of the controlled axes; with fins, surge only.
  std::vector<int> axes;
  for (const std::string& axis : params.axes)
    axes.push_back(
        static_cast<int>(std::find(wrench_axes().begin(), wrench_axes().end(), axis) - wrench_axes().begin()));
  if (axes.empty() && !params.fins.empty()) axes = {0};
  try {
    allocation_.emplace(places, axes);
  } catch (const std::invalid_argument& error) {
    refuse(context, std::string("'axes': ") + error.what());
  }
}

void AutopilotActuators::add_fins(const AutopilotParams& params, const sim::DeviceContext& context) {
  if (params.fins.empty()) return;
  // Pitch and yaw torque of each fin per rad and (m/s)^2.
  Eigen::MatrixXd torque(2, static_cast<Eigen::Index>(params.fins.size()));
  for (std::size_t i = 0; i < params.fins.size(); ++i) {
    const auto [config, fin] = described<Fin::Params>(context, "fins", params.fins[i], "fin");
    const sim::Pose X_BF = config->X_BS();
    sim::Vector3d one = fin->coefficients ? fin->coefficients->moment : sim::Vector3d::Zero();
    if (!fin->coefficients)
      one = 0.5 * fin->density_kgpm3.value_or(plan_density_kgpm3) * fin->area_m2 * fin->foil.slope() *
            X_BF.translation().cross(X_BF.linear().col(1));
    torque.col(static_cast<Eigen::Index>(i)) = one.tail<2>();
    planes_.push_back({{params.fins[i]}, fin->limit_rad});
  }
  // The pseudo-inverse ignores fins with a negligible effect on an axis.
  fin_angles_.resize(torque.cols(), 2);
  for (Eigen::Index axis = 0; axis < 2; ++axis)
    fin_angles_.col(axis) = sim::least_squares(torque, Eigen::Vector2d::Unit(axis));
  fin_torques_ = torque;
  if (torque.norm() < 1e-9 || !fin_angles_.allFinite()) refuse(context, "'fins' neither pitch nor turn the vehicle");
}

CraftAbilities AutopilotActuators::abilities() const {
  CraftAbilities craft;
  craft.mass = mass_;
  craft.fins = !planes_.empty();
  craft.sideways = gives(1);
  craft.heaves = gives(2);
  return craft;
}

AutopilotActuators::Given AutopilotActuators::share(const Wrench& wrench, const sim::Vector3d& v_B,
                                                    double density_kgpm3) {
  // Allocate the wrench to the thrusters, whose thrust depends on their inflow too.
  const double density = density_kgpm3 > 0 ? density_kgpm3 : plan_density_kgpm3;
  constexpr double all = 1 - 1e-9, rounding_N = 1e-6;
  Given given;
  given.saturated = allocation_->allocate(wrench, forces_N_) < all;
  for (std::size_t i = 0; i < propellers_.size(); ++i) {
    Propeller& propeller = propellers_[i];
    double& force_N = forces_N_[static_cast<Eigen::Index>(i)];
    const double inflow_mps = propeller.axis_B.dot(v_B), desired_N = force_N;
    propeller.device.command = propeller.curve.command_for_N(desired_N, inflow_mps, density);
    force_N = propeller.curve.force_N(propeller.device.command, inflow_mps, density);
    given.saturated = given.saturated || std::abs(force_N - desired_N) > rounding_N * (1 + std::abs(desired_N));
  }
  given.wrench = allocation_->wrench_of(forces_N_);
  if (planes_.empty()) return given;
  // Deflect the fins in proportion to torque over speed squared.
  const double speed = std::max(slowest_mps, v_B.x());
  Eigen::VectorXd angles = fin_angles_ * wrench.tail<2>() / (speed * speed);
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    Plane& plane = planes_[i];
    double& angle = angles[static_cast<Eigen::Index>(i)];
    plane.device.command = std::clamp(angle, -plane.limit_rad, plane.limit_rad);
    given.saturated = given.saturated || plane.device.command != angle;
    angle = plane.device.command;
  }
  given.wrench.tail<2>() += fin_torques_ * angles * (speed * speed);
  return given;
}

void AutopilotActuators::publish(Driven& device, sim::Time now) {
  shoal::actuator_command_t message{};
  message.utime = epoch_us_ + vehicle_.clock().reading(now).count();
  message.value = device.command;
  shoal::encode_into(message, payload_);
  if (!device.channel)
    device.channel = vehicle_.bus().open_channel(vehicle_.find_device(device.name)->command_channel());
  device.channel->publish(payload_, now);
}

void AutopilotActuators::publish(sim::Time now) {
  for (Propeller& propeller : propellers_) publish(propeller.device, now);
  for (Plane& plane : planes_) publish(plane.device, now);
}

}  // namespace devices
