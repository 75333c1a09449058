// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>

#include "sim/bus/byte_port.hpp"
#include "sim/bus/message_gate.hpp"
#include "sim/device/shared_by_devices.hpp"
#include "sim/event/event_queue.hpp"
#include "sim/vehicle/step_clock.hpp"
#include "sim/vehicle/world_warnings.hpp"

namespace sim {

class AcousticChannel;
class PhysicsWorld;
class World;
struct ChannelConfig;

/// Services of a world for its devices, shared by all of them.
struct DeviceHost {
  const World& world;  ///< for queries
  const ChannelConfig& channels;
  const StepClock& clock;
  std::int64_t epoch_us;
  std::uint64_t seed;
  PhysicsWorld& physics;
  const std::unique_ptr<AcousticChannel>& acoustics;
  EventQueue& events;
  const PortOpener& open_port;  ///< for devices with a pseudo-terminal or FIFO; empty: none can be opened
  WorldWarnings& warnings;
  SharedByDevices& shared;
  ArrivalFlags& awake;  ///< by device number: false for one that sleeps, see Actuator

  /// Schedules the arrival of data at a device at a simulated time, when arrive() of its sensor is called.  `device`:
  /// its number.
  void schedule_arrival(int device, Time due, Bytes payload);
};

}  // namespace sim
