// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim/config/param_info.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/device/device_registry.hpp"

namespace tools {

/// Returns a page of docs/ that is generated from the program.  A test fails when one is out of date.
/// Page names: devices, world_format, messages, metrics, programs.  Throws std::out_of_range for any other.
std::string reference_page(const std::string& name);

/// Returns the output of `shoal describe NAME`, in lines of at most `columns` characters where its words allow: a
/// device type, `device` (keys of all devices), `world`, `vehicle`, `noise`, `metrics`, a message type, or a program
/// with a declaration.  Empty for an unknown name.
std::string describe_text(const std::string& name, std::size_t columns = 1000);

/// Returns a title and a table of keys, in the form of describe_text().
std::string describe_keys(const std::string& title, const std::vector<sim::ParamInfo>& params,
                          std::size_t columns = 1000);

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
