// SPDX-License-Identifier: BSD-3-Clause
#include "devices/joint/joint_of_device.hpp"

#include <stdexcept>

#include "sim/config/diagnostics.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace devices {

namespace {

/// Returns a text such as: joint 'lift' is a slider.
std::string what_it_is(const sim::Joint& joint, const std::string& name) {
  const std::string type(word_of(sim::joint_type_words, joint.type()));
  switch (joint.type()) {
    case sim::JointType::fixed:
      return "joint '" + name + "' is fixed";
    case sim::JointType::ball:
      return "joint '" + name + "' is a ball joint";
    case sim::JointType::hinge:
    case sim::JointType::hinge2:
    case sim::JointType::universal:
    case sim::JointType::slider:
      break;
  }
  return "joint '" + name + "' is a " + type;
}

}  // namespace

void refuse(const sim::DeviceContext& context, const std::string& text) {
  sim::throw_config_error(context.config.place,
                          "vehicle '" + context.vehicle.name() + "': device '" + context.config.name + "'", text);
}

sim::Joint& joint_with_axis(const sim::DeviceContext& context, const std::string& name, int axis) {
  sim::Joint& joint = context.joint(name);
  if (joint.type() == sim::JointType::ball && joint.axes() > 0)
    refuse(context, what_it_is(joint, name) + "; a device of type joint_drive moves it");
  if (axis >= joint.axes())
    refuse(context,
           what_it_is(joint, name) + " and has no axis" + (joint.axes() > 0 ? " " + std::to_string(axis) : ""));
  return joint;
}

sim::Joint& wheel_joint(const sim::DeviceContext& context, const std::string& name) {
  sim::Joint& joint = context.joint(name);
  if (!sim::joint_info(joint.type()).carries_a_wheel)
    refuse(context, what_it_is(joint, name) + "; a wheel must be on a hinge or hinge2");
  return joint;
}

const sim::JointConfig& joint_config(const sim::Vehicle& vehicle, const std::string& name) {
  for (const sim::JointConfig& joint : vehicle.config().joints)
    if (joint.name == name) return joint;
  throw std::out_of_range(name);
}

}  // namespace devices
