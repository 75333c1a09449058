// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/clock/oscillator.hpp"
#include "sim/device/device_config.hpp"
#include "sim/model/physics_config.hpp"

namespace sim {

/// A kind of vehicle, as a vehicle file describes it.
struct VehicleConfig {
  int shoal = 1;        ///< version of the file format
  std::string vehicle;  ///< name of the kind
  std::string description;
  ConfigNode parameters;  ///< name: default value, for ${name} in the file
  std::vector<MaterialConfig> materials;
  std::vector<ContactConfig> contacts;
  std::vector<std::string> categories;
  bool self_collision = false;
  double actuator_latency_s = 0;  ///< from command to effect, added to each actuator's own
  ClockConfig clock;
  std::vector<BodyConfig> bodies;  ///< the first one carries the vehicle frame
  std::vector<JointConfig> joints;
  std::vector<DeviceConfig> devices;
  std::shared_ptr<const ConfigNode> source;  ///< what it was read from, parameters put in; null: made by hand

  void read(ParamReader& in);
  /// Makes its bodies and parts known to what names them.
  void declare_bodies(ParamReader& in) const;
};

}  // namespace sim
