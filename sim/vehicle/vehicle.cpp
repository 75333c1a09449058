// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/vehicle.hpp"

#include <stdexcept>

#include "sim/vehicle/mounted_device.hpp"

namespace sim {

namespace {

template <typename Part>
Part& find_named(const std::vector<std::pair<std::string, Part*>>& all, const std::string& name) {
  for (const auto& [each, part] : all)
    if (each == name) return *part;
  throw std::out_of_range(name);
}

}  // namespace

Vehicle::Vehicle(std::string name, int number, int group, std::shared_ptr<const VehicleConfig> config, Bus& bus,
                 VehicleClock clock)
    : name_(std::move(name)),
      number_(number),
      group_(group),
      config_(std::move(config)),
      bus_(bus),
      X_BV_(make_pose(config_->bodies.front().position_m, config_->bodies.front().rpy_rad).inverse()),
      clock_(std::move(clock)) {}

Pose Vehicle::X_WV() const {
  return base().X_WB() * X_BV_;
}

MountedDevice* Vehicle::find_device(const std::string& name) const {
  for (MountedDevice* device : devices_)
    if (device->config().name == name) return device;
  return nullptr;
}

Body& Vehicle::body(const std::string& name) const {
  return find_named(bodies_, name);
}

Joint& Vehicle::joint(const std::string& name) const {
  return find_named(joints_, name);
}

}  // namespace sim
