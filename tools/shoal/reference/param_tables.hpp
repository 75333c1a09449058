// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sim/config/param_reader.hpp"
#include "sim/device/device_registry.hpp"

namespace tools {

/// Returns the keys that a struct reads.
template <typename Config>
std::vector<sim::ParamInfo> params_of() {
  std::vector<sim::ParamInfo> table;
  sim::ParamReader in(table);
  Config config;
  config.read(in);
  return table;
}

/// Returns the keys of every device.
inline std::vector<sim::ParamInfo> common_params() {
  std::vector<sim::ParamInfo> table;
  sim::ParamReader in(table);
  sim::DeviceConfig config;
  config.read_common(in);
  return table;
}

/// Returns the keys of one device type, and of actuators if it is one, in addition to those of every device.
inline std::vector<sim::ParamInfo> params_of(const sim::DeviceType& type) {
  std::vector<sim::ParamInfo> table;
  sim::ParamReader in(table);
  sim::DeviceConfig config;
  if (type.is_actuator()) config.read_actuator(in, type);
  type.make_params()->read(in);
  return table;
}

}  // namespace tools
