// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>

#include "sim/bus/byte_port.hpp"
#include "sim/device/shared_by_devices.hpp"
#include "sim/event/event_queue.hpp"
#include "sim/vehicle/step_clock.hpp"
#include "sim/vehicle/world_warnings.hpp"

namespace sim {

class AcousticChannel;
class PhysicsWorld;
class World;
struct ChannelConfig;

/// The services of a world that its devices may use in addition to queries; shared by all of them.
struct DeviceHost {
  const World& world;  ///< to be asked
  const ChannelConfig& channels;
  const StepClock& clock;
  std::int64_t epoch_us;
  std::uint64_t seed;
  PhysicsWorld& physics;
  const std::unique_ptr<AcousticChannel>& acoustics;
  EventQueue& events;
  const PortOpener& open_port;  ///< for devices that talk through a pseudo-terminal or FIFO; empty: there are none
  WorldWarnings& warnings;
  SharedByDevices& shared;

  /// Something sent now arrives at a device at a simulated time: its sensor's arrive() is called.  `device`: its
  /// number.
  void schedule_arrival(int device, Time due, Bytes payload);
};

}  // namespace sim
