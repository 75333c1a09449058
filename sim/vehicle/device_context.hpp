// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/acoustics/sound_site.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/random/noise.hpp"
#include "sim/vehicle/device_host.hpp"

namespace sim {

class Body;
class Joint;
class Vehicle;
class World;

/// What a device may hold on to while it is built.
struct DeviceContext {
  const World& world;          ///< the world that is being built
  Vehicle& vehicle;            ///< the vehicle that carries the device
  const DeviceConfig& config;  ///< the keys of the device
  Body& body;                  ///< that the device is mounted on
  int number;                  ///< of the device in the world, for DeviceHost::schedule_arrival
  DeviceFaults& faults;        ///< the faults of the device, for its Noise
  DeviceHost& host;            ///< outlives the device

  /// Throws std::out_of_range: names were checked when the file was read.
  Joint& joint(const std::string& name) const;
  std::string full_name() const;  ///< such as `rover1/lidar`
  /// What it shares with other devices of the world.
  template <typename T>
  T& shared(const SharedKind<T>& kind) const {
    return host.shared.of(kind);
  }
  /// The error of a quantity, with its own random stream, which faults can reach; both are named after the key
  /// that `params` was read by.  `values`: how many have slow parts of their own (axes of a vector).
  Noise noise(const NoiseParams& params, int values) const;
  /// Random stream and faults of a quantity, named after the key that `params` was read by.
  NoiseOrigin noise_origin(const NoiseParams& params) const;
  /// For a Transducer or a ContinuousSound.  Throws ConfigError at the device's place when the world has no water.
  SoundSite sound_site() const;
};

}  // namespace sim
