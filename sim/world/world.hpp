// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <typeindex>
#include <vector>

#include "sim/base/geodesy.hpp"
#include "sim/base/thread_pool.hpp"
#include "sim/bus/bus.hpp"
#include "sim/bus/byte_port.hpp"
#include "sim/bus/mail_flags.hpp"
#include "sim/event/event_queue.hpp"
#include "sim/hydrodynamics/hydrodynamics.hpp"
#include "sim/medium/medium.hpp"
#include "sim/physics/physics_world.hpp"
#include "sim/world/mounted_device.hpp"
#include "sim/world/vehicle.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

/// The bus of a name.
using BusFinder = std::function<Bus&(const std::string& name)>;

/// What a step of the world cost in work; equal in every run.
struct WorldCounts {
  std::int64_t samples = 0;
  std::int64_t bad_messages = 0;
  void visit_state(StateArchive& archive) { archive(samples, bad_messages); }
};

class AcousticChannel;
class RunHash;
class Script;
class WorldJournal;
struct ZoneRecord;

/// A thing without devices, as built.
struct WorldObject {
  std::int64_t number = 0;  ///< grows from object to object, and is not used again
  std::string name;
  int group = -1;
  Body* body = nullptr;
  ObjectConfig config;
};

/// Why and how the world itself ends the run.
struct EndOfRun {
  std::string text;
  bool passed = true;
  void visit_state(StateArchive& archive) { archive(text, passed); }
};

/// Something that cannot be done to the world as it is now.  what() is one line that says who, rule and value.
class WorldError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A world as built: bodies, vehicles, devices and the events between them.  Steps when told to; knows no clock.
class World {
 public:
  /// `config` must outlive the world.  `open_port` serves devices that talk through a pseudo-terminal or FIFO.
  /// Throws ConfigError for what only building can find (mesh files, masses).
  /// `find_bus` gives the bus of a name in `config.buses`; without it everybody is on `bus`.
  World(const WorldConfig& config, Bus& bus, PortOpener open_port = {}, BusFinder find_bus = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Threads that share the sensors which cast rays; 0: one for each processor.  The run is the same for any number.
  void use_threads(int threads);

  /// Stages 1 to 7 of a step: mail, act, medium, script, physics, sense, report.  Throws PhysicsFault.
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
  /// Water and air at the time of the world: in stages 1 to 5 that of the start of the step, then that of its end.
  const Medium& medium() const { return medium_; }
  const Hydrodynamics& hydrodynamics() const { return *hydrodynamics_; }
  /// What carries sound between transducers.
  AcousticChannel& acoustics() { return *acoustics_; }
  const AcousticChannel& acoustics() const { return *acoustics_; }
  const Geodesy& geodesy() const { return geodesy_; }
  std::span<const std::unique_ptr<Vehicle>> vehicles() const { return vehicles_; }
  const Vehicle* find_vehicle(const std::string& name) const;
  /// In the order of their numbers; null where a device was removed.
  std::span<const std::unique_ptr<MountedDevice>> devices() const { return devices_; }
  /// By vehicle and device, such as `auv1/imu`.  Null when there is none.
  MountedDevice* find_device(const std::string& full_name) const;
  const WorldObject* find_object(const std::string& name) const;
  /// By name.
  const std::map<std::string, WorldObject, std::less<>>& objects() const { return objects_; }
  /// Grows with every vehicle or object that comes or goes: who holds pointers to them asks again then.
  std::uint64_t generation() const { return generation_; }

  // What changes a world while it runs.  Call between steps, or from a script in stage 4.

  /// Adds a vehicle.  Throws ConfigError (names and channels that are taken, meshes, masses, limits, contacts that
  /// would change the surfaces of others, a place where something stands), and the vehicle is not there then.
  const Vehicle& add_vehicle(const VehicleInstance& instance);
  /// Throws WorldError when there is none, or when a metric scores it.
  void remove_vehicle(const std::string& name);
  void check_removable(const std::string& vehicle) const;
  /// Moves all bodies of a vehicle so that its frame stands at X_WV, at rest.  Throws WorldError.
  void move_vehicle(const std::string& name, const Pose& X_WV);
  /// Adds one object (config.count is not looked at).  Throws ConfigError as add_vehicle does.
  const WorldObject& add_object(const ObjectConfig& config, const std::string& name, const Pose& X_WE);
  /// Throws WorldError when there is none.
  void remove_object(const std::string& name);
  /// Puts an object's frame at a pose, at rest.  Throws WorldError.
  void move_object(const std::string& name, const Pose& X_WE);
  /// Throw WorldError when there is no such device, or the fault does not fit it.
  void set_fault(const std::string& device, const FaultConfig& fault);
  void clear_faults(const std::string& device);
  /// Gives a device other values while it runs.  False: `diagnostics` say why, and nothing has changed.
  bool change_device(const std::string& full_name, const ConfigNode& values, Diagnostics& diagnostics);
  /// Sends a message, as a script does, on the bus of the device whose channel it is, else on the world's.
  void publish(const std::string& channel, std::span<const std::byte> payload);
  /// The run ends after this step; the first call counts.
  void end(const EndOfRun& end);
  const std::optional<EndOfRun>& ended() const { return ended_; }
  /// Carries out one action (a map) or several (a list of maps), as in `events:`.  Throws ConfigError.
  void run_action(const ConfigNode& action);
  /// Warns of something that went wrong in the world and counts it; the same line is told once.
  void complain(const std::string& who, const std::string& text);

  /// Something sent now to a device arrives there at a simulated time: its sensor's arrive() is called.
  void schedule_arrival(int device, Time due, Bytes payload);
  /// What the devices of one kind share (the channel between modems).  Made at the first call.
  template <typename T>
  T& shared() {
    std::shared_ptr<void>& slot = shared_[std::type_index(typeid(T))];
    if (!slot) slot = std::make_shared<T>();
    return *static_cast<T*>(slot.get());
  }
  const PortOpener& open_port() const { return open_port_; }
  /// The world's own.
  Bus& bus();
  /// Where a channel is spoken: the bus of the vehicle whose device has it, else the world's.
  Bus& bus_of_channel(const std::string& channel);

  const Zones& zones() const;
  /// By vehicle, when the world has zones with a speed limit or a finish.
  const std::map<std::string, ZoneRecord>& zone_records() const;
  /// How often the event of this name has fired; nothing when there is none.
  std::optional<std::int64_t> event_firings(const std::string& name) const;
  const WorldCounts& counts() const { return counts_; }

  /// A hash over all that is state: bodies, joints, devices, clocks, medium, events, sound under way, script.
  std::uint64_t state_hash() const;
  /// A hash over the whole way here: every message that devices and events have published, the motion of every body
  /// after each step, the whole state after every tenth step and now.  Equal ones prove equal runs, equal state hashes
  /// only equal ends.  What is published for observation alone does not count; see RunHash.  A snapshot holds it.
  std::uint64_t run_hash() const;
  /// The state hash by part, in an order that does not change: `world`, `medium`, vehicles such as `auv1`, devices such
  /// as `auv1/dvl`, `objects`, `events`, `acoustics`, `script`.
  std::vector<PartHash> part_hashes() const;
  /// All of the state between two steps, and what has come, gone and been changed since the start.  Throws
  /// SnapshotError when a vehicle or object was added that was not read from YAML.
  Bytes snapshot() const;
  /// Goes to a snapshot of a world of the same configuration, of this one or of another process, and on from there
  /// with the same bits.  When vehicles, objects or the parameters of devices are not those of the snapshot, the world
  /// is built anew in place: references to vehicles, bodies, devices and scene are then void, and generation() has
  /// grown; those to World and PhysicsWorld hold.  Throws SnapshotError when it does not fit; the world is then as
  /// before, or where that is not possible as well the error says so.  It may have been built anew on the way there:
  /// see generation().
  void restore(std::span<const std::byte> snapshot);

 private:
  friend class WorldJournal;
  void build();
  void take_all_apart();
  void build_again();
  void visit_state(StateArchive& archive);
  void visit_mail(StateArchive& archive);
  void restore_state(std::span<const std::byte> snapshot);
  void add_objects();
  const WorldObject& build_object(const ObjectConfig& config, const std::string& name, const Pose& X_WE);
  Vehicle& build_vehicle(const VehicleInstance& instance);
  void build_parts_of(Vehicle& vehicle, const VehicleInstance& instance);
  Bus& bus_of(const std::string& name);
  void add_device(Vehicle& vehicle, const DeviceConfig& config);
  void remove_device(MountedDevice& device);
  void take_apart(Vehicle& vehicle);
  void take_apart(const WorldObject& object);
  void bring_surfaces(const VehicleConfig& config);
  const WorldObject& place_object(const ObjectConfig& config, const std::string& name, const Pose& X_WE);
  bool apply_change(const std::string& full_name, const ConfigNode& values, Diagnostics& diagnostics);
  Vehicle& vehicle_named(const std::string& name) const;
  const WorldObject& object_named(const std::string& name) const;
  MountedDevice& device_named(const std::string& name) const;
  void check_new_vehicle(const VehicleInstance& instance) const;
  void check_new_surfaces(const VehicleInstance& instance) const;
  void check_place_is_free(Vehicle& vehicle, const SourcePlace& place);
  void check_new_name(const std::string& name, const SourcePlace& place, const std::string& who) const;
  void sort_devices();
  void run_due_events();
  void advance_clocks();
  void sense();
  void cast_rays();
  void add_to_run_hash();

  const WorldConfig& config_;
  Bus& bus_;
  BusFinder find_bus_;
  PortOpener open_port_;
  std::int64_t step_us_;
  double step_s_;
  std::int64_t step_number_ = 0;
  bool in_step_ = false;  ///< also after a step that threw
  Geodesy geodesy_;
  EventQueue events_;
  DeviceHost host_;
  WorldCounts counts_;
  std::vector<std::string> complaints_;
  // By key only, never iterated.  Declared before the devices, which use it to their end.
  std::map<std::type_index, std::shared_ptr<void>> shared_;
  std::unique_ptr<PhysicsWorld> physics_;
  Medium medium_;
  std::optional<Hydrodynamics> hydrodynamics_;
  std::unique_ptr<AcousticChannel> acoustics_;
  std::vector<std::unique_ptr<Vehicle>> vehicles_;
  std::map<std::string, Vehicle*, std::less<>> vehicles_by_name_;
  std::map<std::string, WorldObject, std::less<>> objects_;
  std::map<std::string, Bus*, std::less<>> channels_;  // those that are taken, and where
  std::set<std::string, std::less<>> known_materials_;
  std::vector<ContactConfig> known_contacts_;
  int next_vehicle_number_ = 0;
  std::int64_t next_object_number_ = 0;
  std::map<const VehicleConfig*, int> built_of_kind_;  ///< only for WorldConfig::bodies_only_of_many
  std::uint64_t generation_ = 0;
  std::optional<EndOfRun> ended_;
  std::vector<std::unique_ptr<MountedDevice>> devices_;
  std::vector<int> free_numbers_;  // of devices that were removed; the last is used first
  // The devices each stage visits, in device order.
  /// A device with a mailbox, and whether there may be something in it.
  struct Listening {
    std::atomic<bool>* mail;
    MountedDevice* device;
  };
  /// A sensor, and the step after which it samples next.
  struct Sensing {
    std::int64_t due_step;
    MountedDevice* device;
    bool casts_rays, sweeps;
  };
  std::vector<Listening> listening_;
  std::vector<Acting*> acting_;
  std::vector<Sensing> sensing_;
  std::vector<Vehicle*> clocked_;  // vehicles whose clocks are not perfect
  MailFlags mail_flags_;
  /// What this step has to sense.
  struct Casting {
    MountedDevice* device;
    bool due;
  };
  std::vector<Sensing*> due_;
  std::vector<Casting> casting_;
  std::unique_ptr<ThreadPool> threads_;  // null: one thread
  std::unique_ptr<Script> script_;
  std::unique_ptr<WorldJournal> journal_;
  Bytes medium_at_start_;
  mutable std::size_t last_snapshot_bytes_ = 0;
  std::unique_ptr<RunHash> run_hash_;  // devices hold on to its buses, and publish nothing at their end
};

}  // namespace sim
