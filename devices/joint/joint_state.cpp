// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/joint_state.hpp"

#include "devices/common/same_size.hpp"
#include "devices/joint/joint_of_device.hpp"
#include "messages/reporter/message_reporter.hpp"
#include "shoal/joint_state_t.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace devices {

void JointState::Params::read(sim::ParamReader& in) {
  in.read_references("joints", joints, "joint", "joints to report, in this order; none: all that have an axis");
  in.read("effort", effort, "measure efforts; false: they are reported as 0");
  in.read("position_noise", position_noise, "error of the positions, rad or m");
  in.read("velocity_noise", velocity_noise, "error of the velocities, rad/s or m/s");
  in.read("effort_noise", effort_noise, "error of the efforts, N m or N");
}

namespace {

std::vector<JointState::Axis> axes_of(const JointState::Params& params, const sim::DeviceContext& context) {
  std::vector<std::string> names = params.joints;
  if (names.empty())
    for (const auto& [name, joint] : context.vehicle.joints())
      if (joint->axes() > 0) names.push_back(name);
  if (names.empty()) refuse(context, "the vehicle has no joint with an axis");
  std::vector<JointState::Axis> axes;
  for (const std::string& name : names) {
    sim::Joint& named = context.joint(name);
    sim::Joint& joint =
        named.type() == sim::JointType::ball && named.axes() > 0 ? named : joint_with_axis(context, name, 0);
    for (int axis = 0; axis < joint.axes(); ++axis)
      axes.push_back({axis == 0 ? name : name + "/" + std::to_string(axis), &joint, axis});
  }
  return axes;
}

}  // namespace

JointState::JointState(const Params& params, const sim::DeviceContext& context)
    : axes_(axes_of(params, context)),
      position_noise_(context, params, static_cast<int>(axes_.size())),
      velocity_noise_(context, params, static_cast<int>(axes_.size())),
      effort_noise_(context, params, static_cast<int>(axes_.size())),
      positions_(axes_.size()),
      velocities_(axes_.size()),
      efforts_(axes_.size()) {
  if (params.effort)
    for (const Axis& axis : axes_) axis.joint->measure_load();
}

void JointState::measure(const sim::SenseContext&) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const auto& [name, joint, axis] = axes_[i];
    positions_[i] = joint->position(axis);
    velocities_[i] = joint->velocity(axis);
    efforts_[i] = joint->effort(axis);
  }
}

void JointState::disturb(double dt_s, sim::Random& random) {
  position_noise_.apply(std::span<double>(positions_), dt_s, random);
  velocity_noise_.apply(std::span<double>(velocities_), dt_s, random);
  effort_noise_.apply(std::span<double>(efforts_), dt_s, random);
}

void JointState::visit_state(sim::StateArchive& archive) {
  archive(position_noise_, velocity_noise_, effort_noise_);
  for (auto* values : {&positions_, &velocities_, &efforts_}) visit_same_size(archive, *values, "axes of joints");
}

void fill(const JointState& state, shoal::joint_state_t& message) {
  message.num_joints = static_cast<std::int16_t>(state.axes().size());
  for (const JointState::Axis& axis : state.axes()) message.joint_name.push_back(axis.name);
  message.joint_position.assign(state.positions().begin(), state.positions().end());
  message.joint_velocity.assign(state.velocities().begin(), state.velocities().end());
  message.joint_effort.assign(state.efforts().begin(), state.efforts().end());
}

SHOAL_SENSOR("joint_state", JointState, shoal::joint_state_t);

}  // namespace devices
