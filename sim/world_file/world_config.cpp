// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/world_config.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <ctime>
#include <set>
#include <sstream>

#include "sim/bus/bus.hpp"
#include "sim/config/common_keys.hpp"
#include "sim/config/config_node.hpp"
#include "sim/config/message_text.hpp"

namespace sim {

void OriginConfig::read(ParamReader& in) {
  in.read("latitude_deg", position.latitude_deg, between(-90, 90), "WGS84 latitude of the world's origin");
  in.read("longitude_deg", position.longitude_deg, between(-180, 180), "WGS84 longitude of the world's origin");
  in.read("height_m", position.height_m, any_number(), "height of the world's origin over the ellipsoid");
}

void RunConfig::read(ParamReader& in) {
  in.read_or_word("duration_s", duration_s, above_to(0, 1e9), {"forever"},
                  "simulated time of the run; forever: until a request to quit");
  in.read_or_word("speed", speed, between(1e-3, 1e6), {"max"}, "times real time; max: as fast as possible");
  in.read("seed", seed, at_least(0), "seed of every random stream");
  in.read("track_rate_hz", track_rate_hz, between(1e-3, 1e6), "samples per second of the tracks in the results");
  in.read_or_word("hash_every_steps", hash_every_steps, between(1, 1e9), {"never"},
                  "steps from hash to hash on sim.hash");
}

void ChannelConfig::read(ParamReader& in) {
  in.read("report", report, "channel of a device's reports; {vehicle} {device} {VEHICLE} {DEVICE} are replaced");
  in.read("command", command, "channel of a device's commands");
  in.read("truth", truth, "channel of a device's readings without errors");
}

void VehicleEntry::read(ParamReader& in) {
  if (in.node() != nullptr) place = in.node()->place;
  in.require("name");
  in.read_name("name", name, "name of the vehicle, unique in the world; part of its channels");
  refuse_reserved(in, name);
  in.read_path("file", file, PathUse::looked_up,
               "vehicle file, beside the world file, in ../vehicles or shipped (shoal list)");
  if (in.has("file")) file_place = in.child("file")->place;
  in.read_raw("model", model, "the vehicle itself, as in a vehicle file, instead of a file");
  in.read("position_m", position_m, any_place(), "place of the vehicle frame in the world");
  in.read_deg("rpy_deg", rpy_rad, "roll, pitch, yaw");
  in.read("count", count, between(1, 100000), "number of instances, named NAME1, NAME2, ...");
  in.read("placement", placement, "placement of the instances when there is a count");
  in.read_raw("parameters", parameters, "values of the vehicle file's ${names}; ${index} counts from 1");
  in.read_reference("bus", bus, "bus", "separate bus, named in `buses`; unset: the world's");
  in.read_raw("overrides", overrides,
              "dotted path: value, such as devices.lidar.rate_hz: 5; NAME3/devices.lidar.rate_hz: one of a count");
  // Both at once would leave open which of them is meant.
  if (!in.describing() && in.has("file") == in.has("model"))
    in.error(in.has("file") ? "needs either 'file' or 'model', not both" : "needs either 'file' or 'model'");
}

void BusConfig::read(ParamReader& in) {
  in.require("name");
  in.read_name("name", name, "name of the bus");
  in.require("lcm_url");
  in.read("lcm_url", lcm_url, "LCM URL, such as udpm://239.255.76.67:7668?ttl=0; each bus has its own port");
  if (in.has("lcm_url") && lcm_url.empty()) in.error("lcm_url", "'lcm_url' must not be empty");
}

namespace {

/// Reads a program and its arguments as a list.  Text instead of a list is an error, which shows the list.
void read_command(ParamReader& in, std::vector<std::string>& command) {
  constexpr const char* meaning =
      "instead of 'program': any program and its arguments; {lcm_url} and {run} are replaced";
  const ConfigNode* node = in.describing() ? nullptr : in.child("command");
  if (node == nullptr || node->kind != ConfigNode::Kind::scalar || node->scalar.empty()) {
    in.read("command", command, meaning);
    if (in.has("command") && command.empty()) in.error("command", "'command' must name a program");
    return;
  }
  const bool has_quotes = node->scalar.find_first_of("\"'\\") != std::string::npos;  // words would be split wrongly
  if (has_quotes)
    return in.error("command", "'command' must be a list of a program and its arguments, got " + shown(*node));
  ConfigNode list;
  list.kind = ConfigNode::Kind::list;
  std::istringstream words(node->scalar);
  for (std::string word; words >> word;) list.items.push_back(scalar_node(word, node->place));
  in.error("command", "'command' must be a list; write 'command: " + shortened(to_flow_yaml(list, 240), 240) + "'");
}

}  // namespace

WorldConfig::WorldConfig() = default;
WorldConfig::WorldConfig(const WorldConfig&) = default;
WorldConfig::WorldConfig(WorldConfig&&) noexcept = default;
WorldConfig& WorldConfig::operator=(const WorldConfig&) = default;
WorldConfig& WorldConfig::operator=(WorldConfig&&) noexcept = default;
WorldConfig::~WorldConfig() = default;

namespace {

/// Checks the text of `program`; the launcher makes the command line from it, by its declaration.
void read_program(ParamReader& in, const char* meaning) {
  std::string program;
  ConfigNode args;
  in.read("program", program, meaning);
  in.read_raw("args", args, "arguments of 'program' by name; in texts {lcm_url} and {run} are replaced");
  if (in.has("program") && program.empty()) in.error("program", "'program' must not be empty");
  if (program.find(' ') != std::string::npos)
    in.error("program", "'program' must be the name or path of a program alone, got '" + shortened(printable(program)) +
                            "'; its arguments go below 'args'");
}

/// Reads how a program takes part in the run.
void read_part(ParamReader& in, ProcessConfig& process, const char* client_meaning) {
  in.read("client", process.client, client_meaning);
  in.read_reference("bus", process.bus, "bus", "its LCM URL is that of this bus, named in `buses`; unset: the world's");
  in.read_choice(
      "on_exit", process.on_exit, {{"continue", OnExit::go_on}, {"end", OnExit::end_run}, {"ignore", OnExit::ignore}},
      "when it ends before the run; continue: the run continues, and fails if the program failed; end: the run ends "
      "with exit code 1; ignore: the run continues, and a failure does not count");
}

/// Bridge to another system: a program of the world as any other, from the list `bridges`.
struct BridgeConfig : ProcessConfig {
  void read(ParamReader& in) {
    in.require("name");
    in.read_name("name", name, "name of the bridge in messages");
    in.require("program");
    read_program(in, "program of the bridge, such as shoal-moos, with a declaration of its arguments");
    read_part(in, *this,
              "client name with which it joins the lockstep; unset: it runs freely, and the run is not repeatable");
  }
};

}  // namespace

void ProcessConfig::read(ParamReader& in) {
  in.require("name");
  in.read_name("name", name, "name of the process in messages");
  read_program(in, "a program with a declaration of its arguments, see docs/guides/program_arguments.md");
  read_command(in, command);
  read_part(in, *this, "client name with which it joins the lockstep; the run then waits for it");
  if (in.describing()) return;
  if (in.has("program") == in.has("command"))
    in.error(in.has("program") ? "needs either 'program' or 'command', not both"
                               : "needs either 'program' with 'args' or 'command'");
  if (in.has("args") && !in.has("program"))
    in.error("args", "'args' needs 'program'; the arguments of 'command' belong into its list");
}

void LockstepConfig::read(ParamReader& in) {
  in.read("timeout_s", timeout_s, between(0.001, 1e6), "wall time to wait for a client's acknowledgement");
  in.read("join_timeout_s", join_timeout_s, between(0.001, 1e6), "wall time to wait for launched clients to join");
  in.read_choice(
      "on_timeout", on_timeout, on_timeout_words,
      "when a client does not answer in timeout_s: wait for it forever, pause the world, continue without it, end the "
      "run with exit code 5; it then applies to all clients, and timeout_s is the maximum that they may request; "
      "unset: each client may give its own when it joins");
  agreed = in.has("on_timeout");
}

void LimitsConfig::read(ParamReader& in) {
  in.read("vehicles", vehicles, between(0, 1000000), "vehicles at any one time, including spawned ones");
  in.read("objects", objects, between(0, 10000000),
          "objects at any one time, including those that scripts or clients add");
  in.read("bodies_per_vehicle", bodies_per_vehicle, between(1, 100000),
          "bodies of a vehicle that a client spawns, or of an object that is added during the run");
  in.read("devices_per_vehicle", devices_per_vehicle, between(0, 100000), "devices of a vehicle that a client spawns");
  in.read("parts", parts, between(1, 100000),
          "parts of one vehicle or object that is added during the run, and joints");
  in.read("spawns_per_client", spawns_per_client, between(0, 100000000),
          "spawn requests of one client in a run; of all clients together ten times as many");
  in.read("rewinds_per_client", rewinds_per_client, between(0, 100000000),
          "rewind and restore requests of one client in a run; of all clients together ten times as many");
  in.read_or_word("step_cpu_s", step_cpu_s, above_to(0, 1e6), {"unlimited"},
                  "CPU time of a step, of the thread that simulates: the run ends after a step that took longer");
}

namespace {

/// Parses `2026-01-01T00:00:00Z` to microseconds since 1970; returns false for text of another form.
bool parse_utc(const std::string& text, std::int64_t& utime) {
  std::tm tm{};
  char end = 0;
  if (std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%2d%c", &tm.tm_year, &tm.tm_mon, &tm.tm_mday, &tm.tm_hour,
                  &tm.tm_min, &tm.tm_sec, &end) != 7 ||
      end != 'Z' || text.size() != 20)
    return false;
  tm.tm_year -= 1900;
  tm.tm_mon -= 1;
  const std::tm desired = tm;
  const std::time_t seconds = timegm(&tm);
  if (tm.tm_mday != desired.tm_mday || tm.tm_mon != desired.tm_mon || tm.tm_hour != desired.tm_hour) return false;
  utime = static_cast<std::int64_t>(seconds) * 1000000;
  return true;
}

/// Declares the names that events may refer to, before they are read, because they refer to each other.
void declare_for_events(ParamReader& in, const WorldConfig& world) {
  std::set<std::string> objects;
  for (const ObjectConfig& object : world.objects)
    for (int i = 1; i <= object.count; ++i)
      objects.insert(object.count == 1 ? object.name : object.name + std::to_string(i));
  const ConfigNode* events = in.describing() ? nullptr : in.child("events");
  if (events != nullptr) {
    for (std::string& name : names_added_by(*events)) objects.insert(std::move(name));
    for (const ConfigNode& event : events->items)
      if (const ConfigNode* name = event.find("name"); name != nullptr) in.declare("event", name->scalar);
  }
  const std::vector<std::string> known = in.declared("object");
  std::set<std::string> movable(objects);
  for (const std::string& name : objects)
    if (!std::binary_search(known.begin(), known.end(), name)) in.declare("object", name);
  for (const std::string& name : in.declared("vehicle")) movable.insert(name);
  for (const std::string& name : movable) in.declare(movable_kind, name);
}

void read_script(ParamReader& in, WorldConfig& world) {
  in.read_list("zones", world.zones, "zone", "regions, for events, denied services and rules");
  for (const ZoneConfig& zone : world.zones) in.declare("zone", zone.name);
  in.read_list("actors", world.actors, "actor", "objects that move along paths");
  for (const ActorConfig& actor : world.actors) in.declare("actor", actor.name);
  declare_for_events(in, world);
  in.read_list("events", world.events, "event", "events and their actions, see docs/guides/dynamic_worlds.md");
}

}  // namespace

void ViewConfig::read(ParamReader& in) {
  in.read("scene", scene, "sim.scene and sim.asset: shapes, materials, devices, water, zones");
  in.read_or_word("bodies_rate_hz", bodies_rate_hz, above_to(0, 1000), {"never"},
                  "rate of sim.bodies: poses of all bodies");
  in.read("sounds", sounds, "sim.sound and sim.sound.arrival: acoustic signals and their outcomes");
  in.read("events", events, "sim.event: events, faults, additions and removals");
  in.read_or_word("scores_rate_hz", scores_rate_hz, above_to(0, 1000), {"never"},
                  "rate of sim.scores: figures and rules");
}

void WorldConfig::read(ParamReader& in) {
  // Identification.
  read_version(in, "shoal", shoal);
  in.read("name", name, "name of the world");
  if (name.find('\n') != std::string::npos) in.error("name", "'name' must be one line");
  in.read("description", description, "description in one sentence");
  in.read("origin", origin, "geographic position of the world");
  in.read("epoch", epoch, "UTC of simulated time 0, as 2026-01-01T00:00:00Z");
  if (!parse_utc(epoch, epoch_us))
    in.error("epoch", "'epoch' must be a UTC time such as 2026-01-01T00:00:00Z, got '" + epoch + "'");
  // Environment and surfaces.
  in.read("physics", physics, "how bodies move");
  in.read("medium", medium, "water and air, see docs/models/medium.md");
  in.read("acoustics", acoustics, "how the water carries sound between devices, see docs/models/acoustics.md");
  in.declare("material", "default");
  in.declare("category", "solid");
  in.read_list("materials", materials, "material", "materials of this world");
  for (const MaterialConfig& material : materials) in.declare("material", material.name);
  in.read_list("contacts", contacts, "contact",
               "contact parameters of pairs of materials; a pair of names has precedence over any, then the last one");
  in.read("categories", categories, "categories of parts, beside `solid`; at most 30");
  for (const std::string& category : categories) in.declare("category", category);
  if (categories.size() > 30) in.error("categories", "'categories' must have at most 30 names");
  in.read("light", light, "sun and sky, for images; see docs/models/cameras.md");
  // Run and channels.
  in.read("channels", channels, "names of the channels");
  in.read("run", run, "defaults of a run, which the command line can override");
  in.read_or_word("state_rate_hz", state_rate_hz, above_to(0, 1e6), {"never"}, "rate of sim.state and sim.clock");
  in.read("view", view, "messages for viewers; no result depends on them");
  in.read_paths("plugins", plugins,
                "libraries with devices, beside this file or installed; only with --launch or --plugin");
  // Objects, buses and vehicles, with the names that scripts use.
  in.read_list("objects", objects, "object", "objects: bodies without devices");
  for (const ObjectConfig& object : objects) in.declare("object", object.name);
  in.read_list("buses", buses, "bus", "separate buses, for vehicles that communicate by modem only");
  for (const BusConfig& bus : buses) in.declare("bus", bus.name);
  for (std::size_t i = 0; i < buses.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (buses[i].lcm_url == buses[j].lcm_url)
        in.error("buses", "buses '" + buses[j].name + "' and '" + buses[i].name + "' have the same 'lcm_url'");
  in.read_list("vehicles", vehicle_entries, "vehicle", "vehicles, by file or model");
  for (const VehicleEntry& entry : vehicle_entries) {
    if (entry.count == 1) in.declare("vehicle", entry.name);
    for (int i = 1; entry.count > 1 && i <= entry.count; ++i) in.declare("vehicle", entry.name + std::to_string(i));
  }
  // Script, programs and limits.
  read_script(in, *this);
  in.read_list("processes", processes, "process", "external programs, started only with --launch");
  for (const ProcessConfig& process : processes) in.declare("process", process.name);
  std::vector<BridgeConfig> bridges;
  in.read_list("bridges", bridges, "bridge",
               "programs that connect the run to other systems, started only with --launch");
  for (const BridgeConfig& bridge : bridges) {
    in.declare("bridge", bridge.name);
    for (const ProcessConfig& process : processes)
      if (process.name == bridge.name) in.error("bridges", "bridge '" + bridge.name + "' has the name of a process");
  }
  processes.insert(processes.end(), bridges.begin(), bridges.end());  // in this order: written_process() counts on it
  in.read("lockstep", lockstep, "waiting for clients");
  in.read("limits", limits, "limits of additions during the run");
  // Metrics and pass rules.
  declare_metrics(in);
  in.read_list("metrics", metrics, "metric", "figures that score the run");
  for (const MetricConfig& metric : metrics) in.declare("metric", metric.name);
  read_rules(in, pass, metrics);
}

void declare_surfaces(ParamReader& in, const WorldConfig& world, const VehicleConfig* vehicle) {
  std::set<std::string> materials{"default"}, categories{"solid"};
  const auto gather = [&](const auto& from) {
    for (const MaterialConfig& material : from.materials) materials.insert(material.name);
    categories.insert(from.categories.begin(), from.categories.end());
  };
  gather(world);
  if (vehicle != nullptr) gather(*vehicle);
  for (const std::string& name : materials) in.declare("material", name);
  for (const std::string& name : categories) in.declare("category", name);
}

std::string device_channel(const ChannelConfig& channels, const std::string& vehicle, const DeviceConfig& device,
                           ChannelKind kind) {
  if (kind == ChannelKind::command) return channel_name(channels.command, vehicle, device.name);
  if (kind == ChannelKind::truth) return channel_name(channels.truth, vehicle, device.name);
  return channel_name(device.channel.empty() ? channels.report : device.channel, vehicle, device.name);
}

std::string channel_error(const std::string& channel, bool taken) {
  if (channel.empty() || channel.size() > Bus::max_channel_length)
    return "a channel must have 1 to 63 characters, got " + std::to_string(channel.size()) + ": '" + channel + "'";
  if (taken) return "channel '" + channel + "' is used twice";
  if (channel.starts_with("sim.")) return "channel '" + channel + "' belongs to the simulator: sim.*";
  return {};
}

std::string channel_name(const std::string& pattern, const std::string& vehicle, const std::string& device) {
  const auto upper = [](std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
  };
  std::string name = pattern;
  const std::pair<std::string, std::string> parts[] = {
      {"{vehicle}", vehicle}, {"{device}", device}, {"{VEHICLE}", upper(vehicle)}, {"{DEVICE}", upper(device)}};
  for (const auto& [key, text] : parts)
    for (std::size_t at = name.find(key); at != std::string::npos; at = name.find(key, at + text.size()))
      name.replace(at, key.size(), text);
  return name;
}

}  // namespace sim
