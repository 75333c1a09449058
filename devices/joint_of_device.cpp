#include "devices/joint_of_device.hpp"

#include <stdexcept>

#include "sim/config/diagnostics.hpp"
#include "sim/world/vehicle.hpp"

namespace devices {

void refuse(const sim::DeviceContext& context, const std::string& text) {
  sim::throw_config_error(context.config.place,
                          "vehicle '" + context.vehicle.name() + "': device '" + context.config.name + "'", text);
}

sim::Joint& joint_with_axis(const sim::DeviceContext& context, const std::string& name, int axis) {
  sim::Joint& joint = context.joint(name);
  if (axis >= joint.axes())
    refuse(context, "joint '" + name + "' is a " + joint.type() + " and has no axis " + std::to_string(axis));
  return joint;
}

const sim::JointConfig& joint_config(const sim::Vehicle& vehicle, const std::string& name) {
  for (const sim::JointConfig& joint : vehicle.config().joints)
    if (joint.name == name) return joint;
  throw std::out_of_range(name);
}

}  // namespace devices
