// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/vehicle.hpp"

#include <utility>

#include "sim/vehicle/mounted_device.hpp"

namespace sim {

Vehicle::Vehicle(std::string name, int number, int group, std::shared_ptr<const VehicleConfig> config, Bus& bus,
                 VehicleClock clock)
    : Mechanism(group, *config),
      name_(std::move(name)),
      number_(number),
      config_(std::move(config)),
      bus_(bus),
      clock_(std::move(clock)) {}

MountedDevice* Vehicle::find_device(const std::string& name) const {
  for (MountedDevice* device : devices_)
    if (device->config().name == name) return device;
  return nullptr;
}

}  // namespace sim
