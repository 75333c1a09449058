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
class WorldWarnings;
struct ConfigNode;
struct EndOfRun;
struct FaultConfig;
struct ObjectConfig;
struct WorldConfig;
struct WorldObject;

/// What actors and events see of a world, and what they may do to it.  The world implements it (WorldEditor), so that
/// this room needs nothing of how worlds are built.
class Stage {
 public:
  virtual ~Stage() = default;

  virtual const WorldConfig& config() const = 0;
  virtual const StepClock& clock() const = 0;
  virtual const Entities& entities() const = 0;
  virtual PhysicsWorld& physics() = 0;
  /// Where a channel is spoken: the bus of the vehicle whose device has it, else the world's.
  virtual Bus& bus_of_channel(const std::string& channel) = 0;
  virtual WorldWarnings& warnings() = 0;
  Time now() const { return clock().now(); }

  /// Throws WorldError when there is none, or when a metric scores it.
  virtual void remove_vehicle(const std::string& name) = 0;
  /// Moves all bodies of a vehicle so that its frame stands at X_WV, at rest.  Throws WorldError.
  virtual void move_vehicle(const std::string& name, const Pose& X_WV) = 0;
  /// Adds one object (config.count is not looked at).  Throws ConfigError (names that are taken, meshes, masses,
  /// limits, contacts that would change the surfaces of others); the object is then not added.
  virtual const WorldObject& add_object(const ObjectConfig& config, const std::string& name, const Pose& X_WE) = 0;
  /// Throws WorldError when there is none.
  virtual void remove_object(const std::string& name) = 0;
  /// Puts an object's frame at a pose, at rest.  Throws WorldError.
  virtual void move_object(const std::string& name, const Pose& X_WE) = 0;
  /// Throw WorldError when there is no such device, or the fault does not fit it.
  virtual void set_fault(const std::string& device, const FaultConfig& fault) = 0;
  virtual void clear_faults(const std::string& device) = 0;
  /// Changes parameters of a device at run time.  False: `diagnostics` has the reasons, and nothing has changed.
  virtual bool change_device(const std::string& full_name, const ConfigNode& values, Diagnostics& diagnostics) = 0;
  /// Downwards, in m/s2, from the next step on.
  virtual void set_gravity(double gravity_mps2) = 0;
  /// Sends a message on the bus of the device whose channel it is, else on the world's.
  virtual void publish(const std::string& channel, std::span<const std::byte> payload) = 0;
  /// The run ends after this step; the first call counts.
  virtual void end(const EndOfRun& end) = 0;
};

}  // namespace sim
