#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <typeindex>
#include <vector>

#include "sim/bus/bus.hpp"
#include "sim/bus/byte_port.hpp"
#include "sim/geodesy.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/world/event_queue.hpp"
#include "sim/world/mounted_device.hpp"
#include "sim/world/vehicle.hpp"
#include "sim/world/world_config.hpp"

namespace sim {

/// What a step of the world cost in work; equal in every run.
struct WorldCounts {
  std::int64_t samples = 0;
  std::int64_t bad_messages = 0;
};

/// A world as built: bodies, vehicles, devices and the events between them.  Steps when told to; knows no clock.
class World {
 public:
  /// `config` must outlive the world.  `open_port` serves devices that talk through a pseudo-terminal or FIFO.
  /// Throws ConfigError for what only building can find (mesh files, masses).
  World(const WorldConfig& config, Bus& bus, PortOpener open_port = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Stages 1 to 7 of a step: mail, act, medium, actors, physics, sense, report.  Throws PhysicsFault.
  void step();

  std::int64_t step_number() const { return step_number_; }
  Time now() const { return Time{step_number_ * step_us_}; }
  Time step_time() const { return Time{step_us_}; }
  std::int64_t epoch_us() const { return config_.epoch_us; }
  const WorldConfig& config() const { return config_; }
  std::uint64_t seed() const { return static_cast<std::uint64_t>(config_.run.seed); }

  PhysicsWorld& physics() { return *physics_; }
  const PhysicsWorld& physics() const { return *physics_; }
  const Scene& scene() const { return physics_->scene(); }
  const Geodesy& geodesy() const { return geodesy_; }
  std::span<const std::unique_ptr<Vehicle>> vehicles() const { return vehicles_; }
  const Vehicle* find_vehicle(const std::string& name) const;
  std::span<const std::unique_ptr<MountedDevice>> devices() const { return devices_; }

  /// Something sent now to a device arrives there at a simulated time: its sensor's arrive() is called.
  void schedule_arrival(int device, Time due, Bytes payload);
  /// The number the device that is being built will have.
  int next_device_number() const { return static_cast<int>(devices_.size()); }
  /// What the devices of one kind share (the channel between modems).  Made at the first call.
  template <typename T>
  T& shared() {
    std::shared_ptr<void>& slot = shared_[std::type_index(typeid(T))];
    if (!slot) slot = std::make_shared<T>();
    return *static_cast<T*>(slot.get());
  }
  const PortOpener& open_port() const { return open_port_; }

  const WorldCounts& counts() const { return counts_; }
  /// A hash over bodies, joints, devices, their random streams and the event queue.
  std::uint64_t state_hash() const;

 private:
  void add_objects();
  void add_vehicle(const VehicleInstance& instance);
  void complain(const BadMessage& bad);

  const WorldConfig& config_;
  PortOpener open_port_;
  std::int64_t step_us_;
  double step_s_;
  std::int64_t step_number_ = 0;
  Geodesy geodesy_;
  EventQueue events_;
  DeviceHost host_;
  WorldCounts counts_;
  std::vector<std::string> complaints_;
  // By key only, never iterated.  Declared before the devices, which use it to their end.
  std::map<std::type_index, std::shared_ptr<void>> shared_;
  std::unique_ptr<PhysicsWorld> physics_;
  std::vector<std::unique_ptr<Vehicle>> vehicles_;
  std::map<std::string, int, std::less<>> vehicle_numbers_;
  std::vector<std::unique_ptr<MountedDevice>> devices_;
  // The devices each stage visits, in device order.
  std::vector<MountedDevice*> listening_, acting_, sensing_;
};

}  // namespace sim
