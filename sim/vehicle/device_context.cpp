// SPDX-License-Identifier: BSD-3-Clause
#include "sim/vehicle/device_context.hpp"

#include <cassert>

#include "sim/acoustics/channel.hpp"
#include "sim/vehicle/vehicle.hpp"

namespace sim {

Joint& DeviceContext::joint(const std::string& name) const {
  return vehicle.joint(name);
}

std::string DeviceContext::full_name() const {
  return vehicle.name() + "/" + config.name;
}

Noise DeviceContext::noise(const NoiseParams& params, int values) const {
  const NoiseOrigin origin = noise_origin(params);
  return {params, values, Random(origin.seed, origin.stream), origin.fault};
}

NoiseOrigin DeviceContext::noise_origin(const NoiseParams& params) const {
  assert(*params.key != '\0');  // set by Params::read
  const std::string quantity = quantity_of(params.key);
  return {host.seed, full_name() + "#" + quantity, &faults.noise_of(quantity)};
}

std::shared_ptr<std::atomic<bool>> DeviceContext::wake_flag() const {
  return host.awake.of(number);
}

SoundSite DeviceContext::sound_site() const {
  AcousticChannel& channel = *host.acoustics;
  if (!channel.has_water())
    throw_config_error(config.place, "vehicle '" + vehicle.name() + "': device '" + config.name + "'",
                       "a device of type '" + config.type +
                           "' needs water to carry its sound: the world has no 'medium: {water: ...}'");
  return {channel, body, config.X_BS(), vehicle.group(), vehicle.systems().powered, faults, full_name()};
}

}  // namespace sim
