// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "sim/device/device_registry.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace experiment {

/// Returns the parameters of a device of this model; null for one of another type.
template <typename Model>
const typename Model::Params* params_as(const sim::DeviceConfig& device) {
  const auto* own = dynamic_cast<const sim::detail::ParamsOf<typename Model::Params>*>(device.params.get());
  return own == nullptr ? nullptr : &own->params;
}

/// Finds the first device of a model and its parameters.
template <typename Model>
struct FirstDevice {
  const sim::DeviceConfig* device = nullptr;
  const typename Model::Params* params = nullptr;

  explicit FirstDevice(const sim::VehicleConfig& vehicle) {
    for (const sim::DeviceConfig& each : vehicle.devices) {
      params = params_as<Model>(each);
      if (params == nullptr) continue;
      device = &each;
      return;
    }
  }
  explicit operator bool() const { return device != nullptr; }
  double period_s(double step_s) const { return device->rate_hz > 0 ? std::max(1 / device->rate_hz, step_s) : step_s; }
};

}  // namespace experiment
