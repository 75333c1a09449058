// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "sim/clock/oscillator.hpp"
#include "sim/device/device_config.hpp"
#include "sim/model/mechanism_config.hpp"

namespace sim {

/// Vehicle model, as described by a vehicle file.
struct VehicleConfig : MechanismConfig {
  int shoal = 1;        ///< version of the file format
  std::string vehicle;  ///< name of the model
  std::string description;
  ConfigNode parameters;  ///< name: default value, for ${name} in the file
  std::vector<MaterialConfig> materials;
  std::vector<ContactConfig> contacts;
  std::vector<std::string> categories;
  double actuator_latency_s = 0;  ///< delay from command to effect, added to that of each actuator
  ClockConfig clock;
  std::vector<DeviceConfig> devices;
  std::shared_ptr<const ConfigNode> source;  ///< source tree with parameters substituted; null: not read from a file

  VehicleConfig();
  VehicleConfig(const VehicleConfig&);
  VehicleConfig(VehicleConfig&&) noexcept;
  VehicleConfig& operator=(const VehicleConfig&);
  VehicleConfig& operator=(VehicleConfig&&) noexcept;
  ~VehicleConfig();

  void read(ParamReader& in);
};

}  // namespace sim
