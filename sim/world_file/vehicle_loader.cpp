// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/vehicle_loader.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "sim/config/file_access.hpp"
#include "sim/config/message_text.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/world_file/data_files.hpp"
#include "sim/world_file/file_kind.hpp"

namespace sim {

namespace {

namespace fs = std::filesystem;

using Parameters = std::vector<std::pair<std::string, ConfigNode>>;

/// Finds a file named in a world: beside the world file, then in ../vehicles, then among the shipped files.
std::string find_file(const std::string& file, const SourcePlace& named_in) {
  const fs::path directory = named_in.file ? fs::path(*named_in.file).parent_path() : fs::path();
  std::vector<fs::path> candidates{directory / file, directory / ".." / "vehicles" / file};
  if (!shipped_folder().empty()) candidates.push_back(fs::path(shipped_folder()) / "vehicles" / file);
  for (const fs::path& candidate : candidates) {
    std::error_code ignored;
    if (fs::is_regular_file(candidate, ignored)) return candidate.lexically_normal().string();
  }
  return {};
}

/// Names that a vehicle file may have been meant by: of files beside the world, and of the shipped ones.  Who spawns a
/// vehicle is not told what lies beside the world.
std::vector<std::string> vehicle_files(const VehicleEntry& entry) {
  std::vector<fs::path> folders;
  if (entry.beside.file == nullptr && entry.place.file != nullptr) {
    const fs::path beside = fs::path(*entry.place.file).parent_path();
    folders.push_back(beside.empty() ? "." : beside);
  }
  if (!shipped_folder().empty()) folders.push_back(fs::path(shipped_folder()) / "vehicles");
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::path& folder : folders)
    for (const fs::directory_entry& file : fs::directory_iterator(folder, error))
      if (file.path().extension() == ".yaml") names.push_back(file.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Returns which shipped world has a vehicle that the command line chose; empty: none.
std::string hint_to_a_world(const VehicleEntry& entry) {
  if (entry.file_place.origin != Origin::command_line || shipped_folder().empty()) return {};
  const std::string vehicle = "file: " + fs::path(entry.file).filename().string();
  std::set<std::string> worlds;
  std::error_code error;
  for (const fs::directory_entry& file : fs::directory_iterator(fs::path(shipped_folder()) / "worlds", error)) {
    if (file.path().extension() != ".yaml" || !file.is_regular_file(error)) continue;
    std::ifstream in(file.path());
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    if (text.find(vehicle) != std::string::npos) worlds.insert(file.path().stem().string());
  }
  if (worlds.empty()) return {};
  return "; world '" + *worlds.begin() + "' has this vehicle; or set --set vehicles." + entry.name + ".parameters={}";
}

bool mentions(const ConfigNode& node, std::string_view text) {
  return any_scalar(node, [&](const std::string& scalar) { return scalar.find(text) != std::string::npos; });
}

/// Returns the vehicle of a `count` in an override such as `rover7/devices.lidar.rate_hz`; empty when it applies to all
/// of them.
std::string_view single_vehicle(const std::string& key) {
  return std::string_view(key).substr(0, key.find('/') == std::string::npos ? 0 : key.find('/'));
}

std::string instance_name(const VehicleEntry& entry, int index) {
  return entry.count == 1 ? entry.name : entry.name + std::to_string(index);
}

/// Returns the vehicles of an entry with own overrides.
std::set<std::string, std::less<>> single_vehicles(const VehicleEntry& entry, const std::string& who,
                                                   Diagnostics& diagnostics) {
  std::set<std::string, std::less<>> names, wrong;
  for (const ConfigNode::Entry& change : entry.overrides.entries)
    if (change.key.find('/') != std::string::npos) names.emplace(single_vehicle(change.key));
  wrong = names;
  for (int i = 1; i <= entry.count && !wrong.empty() && entry.count > 1; ++i) wrong.erase(instance_name(entry, i));
  const std::string known = entry.count == 1 ? "a '/' is for the vehicles of a 'count'"
                                             : "the vehicles of this 'count' are " + instance_name(entry, 1) + " to " +
                                                   instance_name(entry, entry.count);
  for (const ConfigNode::Entry& change : entry.overrides.entries)
    if (const auto name = std::string(single_vehicle(change.key));
        change.key.find('/') != std::string::npos && wrong.contains(name))
      diagnostics.error(change.place, who, "'overrides' names no vehicle '" + shortened(name) + "': " + known);
  return names;
}

/// Returns a key that is equal for entries whose vehicles differ only in name and pose.
std::string what_is_said(const VehicleEntry& entry, const ConfigNode& model) {
  return std::to_string(reinterpret_cast<std::uintptr_t>(&model)) + "\n" + to_yaml(entry.parameters) + "\n" +
         to_yaml(entry.overrides);
}

}  // namespace

std::vector<VehicleInstance> VehicleLoader::load(const VehicleEntry& entry) {
  const std::string who = "vehicle '" + entry.name + "'";
  const ConfigNode* model = model_of(entry, who);
  if (model == nullptr) return {};
  // Place the instances.
  const Pose X_WE = make_pose(entry.position_m, entry.rpy_rad);
  const std::vector<Pose> poses = entry.count == 1
                                      ? std::vector<Pose>{X_WE}
                                      : place_instances(entry.placement, entry.count, X_WE,
                                                        static_cast<std::uint64_t>(world_.run.seed), entry.name);
  // Decide which instances share a configuration.
  const auto singles = single_vehicles(entry, who, diagnostics_);
  const auto none_mentions = [&](std::string_view text) {
    return !mentions(*model, text) && !mentions(entry.parameters, text) && !mentions(entry.overrides, text);
  };
  const bool alike = none_mentions("${index}");
  std::vector<VehicleInstance> instances;
  std::shared_ptr<const VehicleConfig> of_this_entry;
  const bool as_in_other_entries = alike && !entry.file.empty() && singles.empty() && none_mentions("${name}");
  std::shared_ptr<const VehicleConfig>& shared =
      as_in_other_entries ? shared_[what_is_said(entry, *model)] : of_this_entry;
  // Make the instances.
  for (int i = 0; i < entry.count; ++i) {
    const std::string name = instance_name(entry, i + 1);
    const Pose& X_WV = poses[static_cast<std::size_t>(i)];
    if (singles.contains(name)) {
      instances.push_back({entry.place, name, X_WV, instance(entry, *model, name, i + 1), entry.bus});
      continue;
    }
    if (!shared || !alike) shared = instance(entry, *model, name, i + 1);
    instances.push_back({entry.place, name, X_WV, shared, entry.bus});
  }
  return instances;
}

void VehicleLoader::resolve(ConfigNode& world_node) const {
  ConfigNode* vehicles = world_node.find("vehicles");
  if (vehicles == nullptr) return;
  for (ConfigNode& vehicle : vehicles->items)
    for (ConfigNode::Entry& entry : vehicle.entries) {
      if (entry.key != "file") continue;
      const auto found = files_.find(find_file(entry.value.scalar, vehicle.place));
      if (found == files_.end()) continue;
      entry.key = "model";
      entry.value = found->second;
    }
}

const ConfigNode* VehicleLoader::model_of(const VehicleEntry& entry, const std::string& who) {
  if (entry.file.empty()) return model_of_node(entry.model, who);
  const std::string path = find_file(entry.file, entry.beside.file != nullptr ? entry.beside : entry.place);
  if (path.empty()) {
    diagnostics_.error(entry.file_place, who,
                       "there is no vehicle file '" + shortened(entry.file) +
                           "' beside the world file, in ../vehicles or among the shipped ones" +
                           did_you_mean(entry.file, vehicle_files(entry)));
    return nullptr;
  }
  if (!may_read(entry, path, who)) return nullptr;
  if (const std::string other = files_.contains(path) ? "" : other_kind(path, FileKind::vehicle); !other.empty()) {
    diagnostics_.error(entry.file_place, who, "'" + shortened(entry.file) + "' is " + other);
    return nullptr;
  }
  // Vehicles of one file share its tree: a fleet reads it once.
  auto [at, fresh] = files_.try_emplace(path);
  if (fresh) at->second = load_config_file(path, diagnostics_, Origin::file);
  return at->second.kind == ConfigNode::Kind::map ? &at->second : nullptr;
}

bool VehicleLoader::may_read(const VehicleEntry& entry, const std::string& path, const std::string& who) {
  if (entry.file_place.origin == Origin::command_line) return true;
  if (diagnostics_.files() == nullptr || diagnostics_.files()->may_read(path)) return true;
  diagnostics_.error(entry.place, who,
                     "'file' " + FileAccess::reading_rule() + ", got '" + shortened(entry.file) + "'");
  return false;
}

const ConfigNode* VehicleLoader::model_of_node(const ConfigNode& model, const std::string& who) {
  if (model.kind == ConfigNode::Kind::map) return &model;
  // An entry without a model at all was reported by the reader.
  if (model.place.file != nullptr) diagnostics_.error(model.place, who, "'model' must be a map, got " + shown(model));
  return nullptr;
}

std::shared_ptr<const VehicleConfig> VehicleLoader::instance(const VehicleEntry& entry, const ConfigNode& model,
                                                             const std::string& name, int index) {
  const std::string who = "vehicle '" + name + "'";
  ConfigNode tree = model;
  const auto& changes = entry.overrides.entries;
  // Changes for all vehicles of a count first, so that those for one of them win.
  for (const ConfigNode::Entry& change : changes)
    if (change.key.find('/') == std::string::npos)
      set_config_path(tree, change.key, change.value, change.place, diagnostics_);
  for (const ConfigNode::Entry& change : changes)
    if (change.key.starts_with(name + "/"))
      set_config_path(tree, change.key.substr(name.size() + 1), change.value, change.place, diagnostics_);
  substitute_parameters(tree, parameters_of(entry, model, who, index), who, diagnostics_);
  return read(std::move(tree), who);
}

std::shared_ptr<const VehicleConfig> VehicleLoader::read(ConfigNode tree, const std::string& who) const {
  auto config = std::make_shared<VehicleConfig>();
  ParamReader in(tree, who, diagnostics_);
  declare_names(in, tree);
  config->read(in);
  in.finish();
  config->source = std::make_shared<const ConfigNode>(std::move(tree));
  return config;
}

void VehicleLoader::declare_names(ParamReader& in, const ConfigNode& tree) const {
  // The vehicle declares its own surfaces; another vehicle may have the same.
  const auto brings = [&](const char* list, const std::string& name) {
    const ConfigNode* items = tree.find(list);
    return items != nullptr && std::any_of(items->items.begin(), items->items.end(), [&](const ConfigNode& item) {
             const ConfigNode* own = item.find("name");
             return (own != nullptr ? own->scalar : item.scalar) == name;
           });
  };
  in.declare("material", "default");
  for (const MaterialConfig& material : world_.materials)
    if (!brings("materials", material.name)) in.declare("material", material.name);
  in.declare("category", "solid");
  for (const std::string& category : world_.categories)
    if (!brings("categories", category)) in.declare("category", category);
}

Parameters VehicleLoader::parameters_of(const VehicleEntry& entry, const ConfigNode& model, const std::string& who,
                                        int index) {
  Parameters parameters;
  parameters.emplace_back("index", scalar_node(std::to_string(index), entry.place));
  parameters.emplace_back("name", scalar_node(entry.name, entry.place));
  const ConfigNode* defaults = model.find("parameters");
  if (defaults != nullptr)
    for (const ConfigNode::Entry& each : defaults->entries) parameters.emplace_back(each.key, each.value);
  for (const ConfigNode::Entry& given : entry.parameters.entries) {
    const auto known =
        std::find_if(parameters.begin(), parameters.end(), [&](const auto& each) { return each.first == given.key; });
    if (known == parameters.end()) {
      diagnostics_.error(given.place, who, "the vehicle has no parameter '" + given.key + "'" + hint_to_a_world(entry));
      continue;
    }
    known->second = given.value;
    // A value given in the world may contain `${index}`, so that one entry with a count gives each vehicle its own.
    substitute_parameters(known->second, {parameters[0]}, who, diagnostics_);
  }
  return parameters;
}

VehicleConfig load_vehicle(const std::string& path, const LoadOptions& options) {
  Diagnostics diagnostics(files_of(path, options));
  ConfigNode tree = load_config_file(path, diagnostics);
  diagnostics.throw_if_any();
  Parameters parameters;
  parameters.emplace_back("index", scalar_node("1", tree.place));
  // A vehicle file alone has no instance, so its parameters get their defaults.
  parameters.emplace_back("name", scalar_node("vehicle", tree.place));
  if (const ConfigNode* defaults = tree.find("parameters"))
    for (const ConfigNode::Entry& each : defaults->entries) parameters.emplace_back(each.key, each.value);
  substitute_parameters(tree, parameters, "", diagnostics);
  VehicleConfig config;
  ParamReader in(tree, "", diagnostics);
  // A world would declare these; materials of the world are unknown here.
  in.declare("material", "default");
  in.declare("category", "solid");
  config.read(in);
  in.finish();
  diagnostics.throw_if_any();
  return config;
}

namespace {

constexpr std::size_t max_request_bytes = 1 << 20;

/// Keys of a spawn request: the entry of `vehicles:` and those of its owner.
struct SpawnEntry {
  VehicleEntry vehicle;
  bool with_client = false;
  double alive_timeout_s = 5;
  void read(ParamReader& in) {
    vehicle.read(in);
    in.read("with_client", with_client, "the vehicle is removed when the client that spawned it leaves");
    in.read("alive_timeout_s", alive_timeout_s, between(0.1, 1e6),
            "wall time after which a silent client counts as gone");
  }
};

enum class Sender { untrusted, journal };

void check_spawn(const SpawnEntry& entry, Sender sender, Diagnostics& diagnostics) {
  const VehicleEntry& vehicle = entry.vehicle;
  const std::string who = "vehicle '" + vehicle.name + "'";
  if (sender == Sender::untrusted)
    for (const ConfigNode* node : {&vehicle.model, &vehicle.parameters, &vehicle.overrides})
      check_untrusted(*node, who, diagnostics);
  if (vehicle.count != 1) diagnostics.error(vehicle.place, who, "'count' must be 1: vehicles are spawned one by one");
  const bool bare = vehicle.file.find('/') == std::string::npos && !vehicle.file.starts_with(".");
  if (!bare) diagnostics.error(vehicle.place, who, "'file' must be a bare file name, got '" + vehicle.file + "'");
}

}  // namespace

void check_untrusted(const ConfigNode& node, const std::string& who, Diagnostics& diagnostics) {
  for (const ConfigNode& item : node.items) check_untrusted(item, who, diagnostics);
  for (const ConfigNode::Entry& entry : node.entries) {
    const std::string key = entry.key.substr(entry.key.find_last_of("./") + 1);
    // Keys of files are refused by their kind; these keys are not of that kind.
    if (key == "serial" || key == "include" || entry.key.find("serial.") != std::string::npos)
      diagnostics.error(entry.place, who, "'" + key + "' cannot be used in a request from the bus");
    check_untrusted(entry.value, who, diagnostics);
  }
}

ConfigNode parse_untrusted(const std::string& text, const std::string& from) {
  Diagnostics diagnostics;
  if (text.size() > max_request_bytes)
    diagnostics.error({intern_file_name(from), 0, 0}, "",
                      "a request must have at most 1 MiB of text, got " + std::to_string(text.size()) + " bytes");
  diagnostics.throw_if_any();
  ConfigNode node = parse_config_text(text, from, diagnostics);
  diagnostics.throw_if_any();
  set_origin(node, Origin::bus);
  return node;
}

namespace {

SpawnRequest read_spawn(const WorldConfig& world, const ConfigNode& node, Sender sender,
                        std::vector<std::string>* hidden = nullptr) {
  Diagnostics diagnostics(world.files);
  SpawnEntry entry;
  ParamReader in(node, "", diagnostics);
  for (const BusConfig& bus : world.buses) in.declare("bus", bus.name);
  entry.read(in);
  in.finish();
  diagnostics.throw_if_any();
  check_spawn(entry, sender, diagnostics);
  diagnostics.throw_if_any();
  // Vehicle files are searched relative to the world file, not to the working directory.
  entry.vehicle.beside.file = intern_file_name(world.file);
  if (hidden != nullptr) diagnostics.hide_files();
  std::vector<VehicleInstance> instances = VehicleLoader(world, diagnostics).load(entry.vehicle);
  if (hidden != nullptr) *hidden = diagnostics.hidden();
  diagnostics.throw_if_any();
  if (instances.empty())
    throw_config_error(entry.vehicle.place, "vehicle '" + entry.vehicle.name + "'", "has no model");
  return {std::move(instances.front()), entry.with_client, entry.alive_timeout_s};
}

}  // namespace

SpawnRequest read_spawn_request(const WorldConfig& world, const std::string& text, std::vector<std::string>* hidden) {
  std::vector<std::string> lines;
  return read_spawn(world, parse_untrusted(text, "spawn"), Sender::untrusted, hidden != nullptr ? hidden : &lines);
}

SpawnRequest read_journalled_spawn(const WorldConfig& world, const std::string& text) {
  Diagnostics diagnostics;
  const ConfigNode node = parse_config_text(text, "spawn", diagnostics);
  diagnostics.throw_if_any();
  return read_spawn(world, node, Sender::journal);
}

std::string self_contained_spawn(const WorldConfig& world, const std::string& text) {
  try {
    ConfigNode node = parse_untrusted(text, "spawn");
    for (ConfigNode::Entry& entry : node.entries) {
      if (entry.key != "file" || entry.value.scalar.find('/') != std::string::npos) continue;
      const std::string path = find_file(entry.value.scalar, {intern_file_name(world.file), 0, 0});
      if (path.empty()) return text;
      Diagnostics diagnostics(world.files);
      ConfigNode model = load_config_file(path, diagnostics, Origin::file);
      diagnostics.throw_if_any();
      make_paths_absolute(model);
      entry.key = "model";
      entry.value = std::move(model);
      return to_yaml(node);
    }
  } catch (const ConfigError&) {  // it will be refused later
  }
  return text;
}

}  // namespace sim
