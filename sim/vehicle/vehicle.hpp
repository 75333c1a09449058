// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/bus/bus.hpp"
#include "sim/clock/vehicle_clock.hpp"
#include "sim/vehicle/mechanism.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace sim {

class MountedDevice;

/// State shared by the devices of a vehicle.
struct VehicleSystems {
  bool estopped = false;  ///< actuators are in their safe states and take no commands
  bool powered = true;    ///< false: the battery is empty; only devices that need no power work
  bool metered = false;   ///< whether there is a battery to discharge
  double drawn_J = 0;     ///< energy drawn since the last update of the battery

  void visit_state(StateArchive& archive) {
    archive(estopped, powered, drawn_J);
    archive.unhashed(metered);  // as it was built
  }
};

/// Vehicle in the world: its bodies, joints and devices by name.
class Vehicle : public Mechanism {
 public:
  /// Makes a vehicle without bodies, joints and devices, which are added in this order.  `clock`: clock of its devices.
  Vehicle(std::string name, int number, int group, std::shared_ptr<const VehicleConfig> config, Bus& bus,
          VehicleClock clock);

  const std::string& name() const { return name_; }
  /// Returns the vehicle number, which increases from vehicle to vehicle and is never reused.
  int number() const { return number_; }
  const VehicleConfig& config() const { return *config_; }
  /// Returns the bus of its devices.
  Bus& bus() const { return bus_; }
  /// Returns a device by name; null when there is none.
  MountedDevice* find_device(const std::string& name) const;
  const std::vector<MountedDevice*>& devices() const { return devices_; }

  VehicleSystems& systems() { return systems_; }
  const VehicleSystems& systems() const { return systems_; }

  /// Returns the clock for the time stamps of its devices.
  VehicleClock& clock() { return clock_; }
  const VehicleClock& clock() const { return clock_; }

  /// Visits bodies, joints, systems and clock; devices are separate parts of the state.
  void visit_state(StateArchive& archive) {
    Mechanism::visit_state(archive);
    archive(systems_, clock_);
  }

  void add_device(MountedDevice& device) { devices_.push_back(&device); }

 private:
  std::string name_;
  int number_;
  std::shared_ptr<const VehicleConfig> config_;
  Bus& bus_;
  std::vector<MountedDevice*> devices_;
  VehicleSystems systems_;
  VehicleClock clock_;
};

}  // namespace sim
