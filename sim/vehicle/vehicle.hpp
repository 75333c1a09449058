// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/base/math.hpp"
#include "sim/bus/bus.hpp"
#include "sim/clock/vehicle_clock.hpp"
#include "sim/physics/body.hpp"
#include "sim/physics/joint.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace sim {

class MountedDevice;

/// What the devices of a vehicle share.
struct VehicleSystems {
  bool estopped = false;  ///< actuators are in their safe states and take no commands
  bool powered = true;    ///< false: the battery is empty; only devices that need no power work
  bool metered = false;   ///< there is a battery to drain
  double drawn_J = 0;     ///< taken since the battery last looked

  void visit_state(StateArchive& archive) {
    archive(estopped, powered, drawn_J);
    archive.unhashed(metered);  // as it was built
  }
};

/// A vehicle in the world: its bodies, joints and devices by name.
class Vehicle {
 public:
  /// Without bodies, joints and devices, which are added in this order.  `clock`: that its devices hold on to.
  Vehicle(std::string name, int number, int group, std::shared_ptr<const VehicleConfig> config, Bus& bus,
          VehicleClock clock);

  const std::string& name() const { return name_; }
  /// Grows from vehicle to vehicle, and is not used again when one is removed.
  int number() const { return number_; }
  int group() const { return group_; }
  const VehicleConfig& config() const { return *config_; }
  /// Where its devices publish and listen.
  Bus& bus() const { return bus_; }
  /// The first body, which carries the vehicle frame.
  const Body& base() const { return *bodies_.front().second; }
  Pose X_WV() const { return base().X_WB() * X_BV_; }

  /// By the name in the vehicle file.  Throws std::out_of_range.
  Body& body(const std::string& name) const;
  Joint& joint(const std::string& name) const;
  /// Null when there is none.
  MountedDevice* find_device(const std::string& name) const;
  const std::vector<std::pair<std::string, Body*>>& bodies() const { return bodies_; }
  const std::vector<std::pair<std::string, Joint*>>& joints() const { return joints_; }
  const std::vector<MountedDevice*>& devices() const { return devices_; }

  VehicleSystems& systems() { return systems_; }
  const VehicleSystems& systems() const { return systems_; }

  /// By which its devices stamp what they report.
  VehicleClock& clock() { return clock_; }
  const VehicleClock& clock() const { return clock_; }

  /// Its bodies, joints, systems and clock; devices are parts of their own.
  void visit_state(StateArchive& archive) {
    for (const auto& [name, body] : bodies_) body->visit_state(archive);
    for (const auto& [name, joint] : joints_) joint->visit_state(archive);
    archive(systems_, clock_);
  }

  void add_body(const std::string& name, Body& body) { bodies_.emplace_back(name, &body); }
  void add_joint(const std::string& name, Joint& joint) { joints_.emplace_back(name, &joint); }
  void add_device(MountedDevice& device) { devices_.push_back(&device); }

 private:
  std::string name_;
  int number_;
  int group_;
  std::shared_ptr<const VehicleConfig> config_;
  Bus& bus_;
  Pose X_BV_;
  std::vector<std::pair<std::string, Body*>> bodies_;
  std::vector<std::pair<std::string, Joint*>> joints_;
  std::vector<MountedDevice*> devices_;
  VehicleSystems systems_;
  VehicleClock clock_;
};

}  // namespace sim
