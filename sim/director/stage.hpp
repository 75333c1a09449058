// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "sim/base/math.hpp"
#include "sim/base/time.hpp"
#include "sim/vehicle/step_clock.hpp"

namespace sim {

class Bus;
class Diagnostics;
class Entities;
class PhysicsWorld;
class WorldObserver;
class WorldWarnings;
struct ConfigNode;
struct EndOfRun;
struct FaultConfig;
struct ObjectConfig;
struct WorldConfig;
struct WorldObject;

/// Interface of a world for actors and events.  WorldEditor implements it, so that this folder does not depend on how
/// worlds are built.
class Stage {
 public:
  virtual ~Stage() = default;

  virtual const WorldConfig& config() const = 0;
  virtual const StepClock& clock() const = 0;
  virtual const Entities& entities() const = 0;
  virtual PhysicsWorld& physics() = 0;
  /// Returns the bus of a channel: that of the vehicle whose device uses it, else that of the world.
  virtual Bus& bus_of_channel(const std::string& channel) = 0;
  virtual WorldWarnings& warnings() = 0;
  /// Returns the observer of the world; null: none.
  virtual WorldObserver* observer() const = 0;
  Time now() const { return clock().now(); }

  /// Removes a vehicle.  Throws WorldError when there is none, or when a metric scores it.
  virtual void remove_vehicle(const std::string& name) = 0;
  /// Moves all bodies of a vehicle so that its frame is at X_WV, with zero velocity.  Throws WorldError.
  virtual void move_vehicle(const std::string& name, const Pose& X_WV) = 0;
  /// Adds one object (config.count is ignored).  Throws ConfigError (name in use, meshes, masses, limits, contacts that
  /// would change the surfaces of others); the object is then not added.
  virtual const WorldObject& add_object(const ObjectConfig& config, const std::string& name, const Pose& X_WE) = 0;
  /// Removes an object.  Throws WorldError when there is none.
  virtual void remove_object(const std::string& name) = 0;
  /// Moves an object so that its frame is at X_WE, with zero velocity.  Throws WorldError.
  virtual void move_object(const std::string& name, const Pose& X_WE) = 0;
  /// Sets or clears faults of a device.  Throws WorldError when there is no such device, or the fault does not apply to
  /// it.
  virtual void set_fault(const std::string& device, const FaultConfig& fault) = 0;
  virtual void clear_faults(const std::string& device) = 0;
  /// Changes parameters of a device at run time.  Returns false when nothing has changed; `diagnostics` then has the
  /// reasons.
  virtual bool change_device(const std::string& full_name, const ConfigNode& values, Diagnostics& diagnostics) = 0;
  /// Sets gravity, downwards, in m/s2, from the next step on.
  virtual void set_gravity(double gravity_mps2) = 0;
  /// Publishes a message on the bus of the device that uses the channel, else on that of the world.
  virtual void publish(const std::string& channel, std::span<const std::byte> payload) = 0;
  /// Ends the run after this step; the first call counts.
  virtual void end(const EndOfRun& end) = 0;
};

}  // namespace sim
