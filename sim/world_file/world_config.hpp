// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/acoustics/acoustics_config.hpp"
#include "sim/base/geodesy.hpp"
#include "sim/config/file_access.hpp"
#include "sim/config/param_reader.hpp"
#include "sim/geometry/zone.hpp"
#include "sim/medium/medium_config.hpp"
#include "sim/model/object_config.hpp"
#include "sim/model/physics_config.hpp"
#include "sim/model/placement.hpp"
#include "sim/scene/light.hpp"
#include "sim/script/actor_config.hpp"
#include "sim/script/event_config.hpp"
#include "sim/world_file/metric_config.hpp"
#include "sim/world_file/on_timeout.hpp"
#include "sim/world_file/vehicle_config.hpp"

namespace sim {

/// Where the world lies on the earth.
struct OriginConfig {
  GeodeticPosition position{42.3584, -71.0876, 0};  // the Charles River at MIT
  void read(ParamReader& in);
};

/// Defaults of a run, which the command line can override.
struct RunConfig {
  double duration_s = 60;  ///< 0: until told to quit
  double speed = 0;        ///< times real time; 0: as fast as possible
  std::int64_t seed = 1;
  double track_rate_hz = 10;            ///< of the tracks in the results
  std::int64_t hash_every_steps = 100;  ///< of the hashes on `sim.hash`; 0: none
  void read(ParamReader& in);
};

/// Names of the channels.  {vehicle}, {device}, {VEHICLE} and {DEVICE} (upper case) are replaced.
struct ChannelConfig {
  std::string report = "{vehicle}.{device}";
  std::string command = "{vehicle}.{device}.cmd";
  std::string truth = "{vehicle}.{device}.truth";
  void read(ParamReader& in);
};

/// An entry of `vehicles:`.
struct VehicleEntry {
  std::string name;
  std::string file;
  ConfigNode model;  ///< the vehicle itself instead of a file
  Vector3d position_m = Vector3d::Zero();
  Vector3d rpy_rad = Vector3d::Zero();
  int count = 1;
  PlacementConfig placement;
  ConfigNode parameters;  ///< name: value
  ConfigNode overrides;   ///< dotted path: value
  std::string bus;        ///< of `buses:`; empty: the world's
  SourcePlace place;
  SourcePlace file_place;  ///< of `file`
  SourcePlace beside;      ///< the file that vehicle files lie beside; unset: `place`
  void read(ParamReader& in);
};

/// A vehicle as it will stand in the world.
struct VehicleInstance {
  SourcePlace place;
  std::string name;
  Pose X_WV = Pose::Identity();
  std::shared_ptr<const VehicleConfig> config;  ///< shared by instances that are alike
  std::string bus;                              ///< name of its own bus; empty: the world's
};

/// A bus beside the world's, so that robots cannot talk around the simulated modem.
struct BusConfig {
  std::string name;
  std::string lcm_url;  ///< such as udpm://239.255.76.67:7668?ttl=0
  void read(ParamReader& in);
};

/// What happens when a program ends before the run.
enum class OnExit {
  go_on,    ///< the run continues, and fails if the program failed
  end_run,  ///< with exit code 1
  ignore,   ///< the run continues, and a failure does not count
};

/// An external program of the experiment, started only with --launch.
struct ProcessConfig {
  std::string name;
  std::vector<std::string> command;  ///< program and arguments; looked up beside the shoal program, then in PATH
  std::string client;                ///< name it joins the lockstep with; empty: it does not
  std::string bus;                   ///< of `buses:`; empty: the world's
  OnExit on_exit = OnExit::go_on;
  void read(ParamReader& in);
};

struct LockstepConfig {
  double timeout_s = 10;       ///< wall time to wait for an acknowledgement
  double join_timeout_s = 30;  ///< wall time to wait for the launched clients to join
  OnTimeout on_timeout = OnTimeout::end_run;
  bool agreed = false;  ///< the file says on_timeout
  void read(ParamReader& in);
};

/// What may come while the world runs.
struct LimitsConfig {
  int vehicles = 2000;  ///< at any one time, those of the world file included
  int objects = 20000;
  int bodies_per_vehicle = 100;
  int devices_per_vehicle = 100;
  int parts = 200;                ///< of one vehicle or object
  int spawns_per_client = 10000;  ///< requests over the whole run; all clients together: ten times as many
  int rewinds_per_client = 1000;  ///< the same, `restore` included
  double step_cpu_s = 0;          ///< CPU time of a step of the world; a longer one ends the run.  0: none
  void read(ParamReader& in);
};

/// Everything a world file says.
struct WorldConfig {
  std::string file;         ///< where it was read
  FileAccessPointer files;  ///< those that may be named, also by later additions; null: any
  int shoal = 1;
  std::string name;
  std::string description;
  OriginConfig origin;
  std::string epoch = "2026-01-01T00:00:00Z";  ///< UTC of simulated time 0
  std::int64_t epoch_us = 0;                   ///< the same in microseconds since 1970
  PhysicsConfig physics;
  MediumConfig medium;
  AcousticsConfig acoustics;
  std::vector<MaterialConfig> materials;
  std::vector<ContactConfig> contacts;
  std::vector<std::string> categories;
  LightConfig light;
  ChannelConfig channels;
  RunConfig run;
  std::vector<std::string> plugins;  ///< loaded by load_world
  std::vector<ObjectConfig> objects;
  std::vector<BusConfig> buses;
  std::vector<VehicleEntry> vehicle_entries;
  std::vector<VehicleInstance> vehicles;  ///< filled by load_world
  std::vector<ProcessConfig> processes;
  LockstepConfig lockstep;
  std::vector<MetricConfig> metrics;
  std::vector<RuleExpression> pass;  ///< the run passes when every rule holds
  LimitsConfig limits;
  std::vector<ZoneConfig> zones;
  std::vector<ActorConfig> actors;
  std::vector<EventConfig> events;
  /// For checks of a file: of more than 100 vehicles of one kind only the first get joints and devices.
  bool bodies_only_of_many = false;
  EncodeMessage encode_message;  ///< for actions that publish; empty: they cannot
  double state_rate_hz = 10;     ///< of sim.state and sim.clock

  void read(ParamReader& in);
};

/// Makes the materials and categories known that parts may name: the world's, and those a vehicle brings (or null).
void declare_surfaces(ParamReader& in, const WorldConfig& world, const VehicleConfig* vehicle = nullptr);

enum class ChannelKind { report, command, truth };
inline constexpr ChannelKind all_channel_kinds[] = {ChannelKind::report, ChannelKind::command, ChannelKind::truth};
/// The channel of a device by the world's templates.
std::string device_channel(const ChannelConfig& channels, const std::string& vehicle, const DeviceConfig& device,
                           ChannelKind kind);

/// What is wrong with a channel of a device; empty: nothing.  `taken`: another device has it.
std::string channel_error(const std::string& channel, bool taken);

/// The channel name a template gives.
std::string channel_name(const std::string& pattern, const std::string& vehicle, const std::string& device);

}  // namespace sim
