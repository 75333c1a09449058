// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <memory>
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

/// Objects available to a device at construction, which it may keep references to.
struct DeviceContext {
  const World& world;          ///< the world that is being built
  Vehicle& vehicle;            ///< the vehicle that carries the device
  const DeviceConfig& config;  ///< the keys of the device
  Body& body;                  ///< body on which the device is mounted
  int number;                  ///< of the device in the world, for DeviceHost::schedule_arrival
  DeviceFaults& faults;        ///< the faults of the device, for its Noise
  DeviceHost& host;            ///< outlives the device

  /// Returns a joint by name.  Throws std::out_of_range: names are checked when the file is read.
  Joint& joint(const std::string& name) const;
  std::string full_name() const;  ///< such as `rover1/lidar`
  /// Returns the object shared with other devices of the world.
  template <typename T>
  T& shared(const SharedKind<T>& kind) const {
    return host.shared.of(kind);
  }
  /// Makes the error of a quantity, with its own random stream, subject to faults; both are named after the key of
  /// `params`.  `values`: number of components with independent slowly varying errors (axes of a vector).
  Noise noise(const NoiseParams& params, int values) const;
  /// Returns the random stream and faults of a quantity, named after the key of `params`.
  NoiseOrigin noise_origin(const NoiseParams& params) const;
  /// Returns the flag that wakes the device when it is set, see Actuator.  The framework sets it when a command or data
  /// arrive, and when parameters or faults change.
  std::shared_ptr<std::atomic<bool>> wake_flag() const;
  /// Returns the site of a Transducer or a ContinuousSound.  Throws ConfigError at the place of the device when the
  /// world has no water.
  SoundSite sound_site() const;
};

}  // namespace sim
