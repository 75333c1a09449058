// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/acoustics/propagation/acoustics_config.hpp"
#include "sim/base/geodesy.hpp"
#include "sim/config/choice_words.hpp"
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
#include "sim/world_file/vehicle_config.hpp"

namespace sim {

/// Action when a client of the lockstep does not answer in time.
enum class OnTimeout {
  wait,     ///< the world waits forever
  pause,    ///< the world pauses until the client answers, or until another one resumes the run without it
  go_on,    ///< the run continues without the client
  end_run,  ///< the run ends with exit code 5
};

inline constexpr ChoiceWords<OnTimeout> on_timeout_words{{"wait", OnTimeout::wait},
                                                         {"pause", OnTimeout::pause},
                                                         {"continue", OnTimeout::go_on},
                                                         {"end", OnTimeout::end_run}};

/// Geodetic origin of the world.
struct OriginConfig {
  GeodeticPosition position{42.3584, -71.0876, 0};  // the Charles River at MIT
  void read(ParamReader& in);
};

/// Defaults of a run, which the command line can override.
struct RunConfig {
  double duration_s = 60;  ///< 0: until a quit request
  double speed = 0;        ///< times real time; 0: as fast as possible
  std::int64_t seed = 1;
  double track_rate_hz = 10;            ///< rate of the tracks in the results
  std::int64_t hash_every_steps = 100;  ///< interval of the hashes on `sim.hash`; 0: none
  void read(ParamReader& in);
};

/// Templates of the channel names.  {vehicle}, {device}, {VEHICLE} and {DEVICE} (upper case) are replaced.
struct ChannelConfig {
  std::string report = "{vehicle}.{device}";
  std::string command = "{vehicle}.{device}.cmd";
  std::string truth = "{vehicle}.{device}.truth";
  void read(ParamReader& in);
};

/// Section `view:`: messages for viewers, which describe what happens in the world.
struct ViewConfig {
  bool scene = true;           ///< sim.scene and sim.asset
  double bodies_rate_hz = 10;  ///< rate of sim.bodies; 0: never
  bool sounds = true;          ///< sim.sound and sim.sound.arrival
  bool events = true;          ///< sim.event
  double scores_rate_hz = 1;   ///< rate of sim.scores; 0: never
  void read(ParamReader& in);
};

/// An entry of `vehicles:`.
struct VehicleEntry {
  std::string name;
  std::string file;
  ConfigNode model;  ///< inline vehicle model instead of a file
  Vector3d position_m = Vector3d::Zero();
  Vector3d rpy_rad = Vector3d::Zero();
  int count = 1;
  PlacementConfig placement;
  ConfigNode parameters;  ///< name: value
  ConfigNode overrides;   ///< dotted path: value
  std::string bus;        ///< name in `buses:`; empty: bus of the world
  SourcePlace place;
  SourcePlace file_place;  ///< of `file`
  SourcePlace beside;      ///< file whose folder is searched for vehicle files; unset: `place`
  void read(ParamReader& in);
};

/// Vehicle to be placed in the world.
struct VehicleInstance {
  SourcePlace place;
  std::string name;
  Pose X_WV = Pose::Identity();
  std::shared_ptr<const VehicleConfig> config;  ///< shared by equal instances
  std::string bus;                              ///< name of its bus; empty: bus of the world
};

/// Additional bus, so that robots can communicate only through the simulated modem.
struct BusConfig {
  std::string name;
  std::string lcm_url;  ///< such as udpm://239.255.76.67:7668?ttl=0
  void read(ParamReader& in);
};

/// Action when a program ends before the run.
enum class OnExit {
  go_on,    ///< the run continues, and fails if the program failed
  end_run,  ///< the run ends with exit code 1
  ignore,   ///< the run continues, and a failure is ignored
};

/// External program of the experiment, started only with --launch.
struct ProcessConfig {
  std::string name;
  std::vector<std::string> command;  ///< program and arguments; searched beside the shoal program, then in PATH
  std::string client;                ///< client name with which it joins the lockstep; empty: it does not join
  std::string bus;                   ///< name in `buses:`; empty: bus of the world
  OnExit on_exit = OnExit::go_on;
  void read(ParamReader& in);
};

struct LockstepConfig {
  double timeout_s = 10;       ///< wall time to wait for an acknowledgement
  double join_timeout_s = 30;  ///< wall time to wait for the launched clients to join
  OnTimeout on_timeout = OnTimeout::end_run;
  bool agreed = false;  ///< whether the file sets on_timeout
  void read(ParamReader& in);
};

/// Limits of additions while the world runs.
struct LimitsConfig {
  int vehicles = 2000;  ///< at any time, including those of the world file
  int objects = 20000;
  int bodies_per_vehicle = 100;
  int devices_per_vehicle = 100;
  int parts = 200;                ///< maximum of one vehicle or object
  int spawns_per_client = 10000;  ///< requests over the whole run; all clients together: ten times as many
  int rewinds_per_client = 1000;  ///< the same, `restore` included
  double step_cpu_s = 0;          ///< CPU time of a step of the world; a longer one ends the run.  0: none
  void read(ParamReader& in);
};

/// Contents of a world file.
struct WorldConfig {
  std::string file;         ///< file from which it was read
  FileAccessPointer files;  ///< rules for the files that may be named, also by later additions; null: any
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
  /// Used to check a file: only the first 100 vehicles of a model get joints and devices.
  bool bodies_only_of_many = false;
  EncodeMessage encode_message;  ///< encoder for actions that publish; empty: they cannot publish
  double state_rate_hz = 10;     ///< rate of sim.state and sim.clock
  ViewConfig view;

  // Defined once: compilers repeat it in each object that holds a world otherwise.
  WorldConfig();
  WorldConfig(const WorldConfig&);
  WorldConfig(WorldConfig&&) noexcept;
  WorldConfig& operator=(const WorldConfig&);
  WorldConfig& operator=(WorldConfig&&) noexcept;
  ~WorldConfig();

  void read(ParamReader& in);
};

/// Declares the materials and categories that parts may name: those of the world, and those of a vehicle (or null).
void declare_surfaces(ParamReader& in, const WorldConfig& world, const VehicleConfig* vehicle = nullptr);

enum class ChannelKind { report, command, truth };
inline constexpr ChannelKind all_channel_kinds[] = {ChannelKind::report, ChannelKind::command, ChannelKind::truth};
/// Returns the channel of a device from the templates of the world.
std::string device_channel(const ChannelConfig& channels, const std::string& vehicle, const DeviceConfig& device,
                           ChannelKind kind);

/// Returns what is wrong with a channel of a device; empty when it is valid.  `taken`: another device uses it.
std::string channel_error(const std::string& channel, bool taken);

/// Returns the channel name of a template.
std::string channel_name(const std::string& pattern, const std::string& vehicle, const std::string& device);

}  // namespace sim
