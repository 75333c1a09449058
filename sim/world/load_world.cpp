#include "sim/world/load_world.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "sim/bus/bus.hpp"
#include "sim/config/message_text.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/device/plugin.hpp"

namespace sim {

namespace {

namespace fs = std::filesystem;

using Parameters = std::vector<std::pair<std::string, ConfigNode>>;

/// Where a file named in a world is found: beside it, then in ../vehicles.
std::string find_file(const std::string& file, const SourcePlace& named_in) {
  const fs::path directory = named_in.file ? fs::path(*named_in.file).parent_path() : fs::path();
  for (const fs::path& candidate : {directory / file, directory / ".." / "vehicles" / file}) {
    std::error_code ignored;
    if (fs::is_regular_file(candidate, ignored)) return candidate.lexically_normal().string();
  }
  return {};
}

bool mentions(const ConfigNode& node, std::string_view text) {
  if (node.scalar.find(text) != std::string::npos) return true;
  return std::any_of(node.items.begin(), node.items.end(),
                     [&](const ConfigNode& item) { return mentions(item, text); }) ||
         std::any_of(node.entries.begin(), node.entries.end(),
                     [&](const ConfigNode::Entry& entry) { return mentions(entry.value, text); });
}

ConfigNode scalar_node(const std::string& text, const SourcePlace& place) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::scalar;
  node.scalar = text;
  node.place = place;
  return node;
}

/// Turns the entries of `vehicles:` into vehicle configurations.
class VehicleLoader {
 public:
  VehicleLoader(WorldConfig& world, Diagnostics& diagnostics) : world_(world), diagnostics_(diagnostics) {}

  void load(const VehicleEntry& entry) {
    const std::string who = "vehicle '" + entry.name + "'";
    const ConfigNode* model = model_of(entry, who);
    if (model == nullptr) return;
    const Pose X_WE = make_pose(entry.position_m, entry.rpy_rad);
    const std::vector<Pose> poses = entry.count == 1
                                        ? std::vector<Pose>{X_WE}
                                        : place_instances(entry.placement, entry.count, X_WE,
                                                          static_cast<std::uint64_t>(world_.run.seed), entry.name);
    const bool alike = !mentions(*model, "${index}") && !mentions(entry.parameters, "${index}") &&
                       !mentions(entry.overrides, "${index}");
    std::shared_ptr<const VehicleConfig> shared;
    for (int i = 0; i < entry.count; ++i) {
      const std::string name = entry.count == 1 ? entry.name : entry.name + std::to_string(i + 1);
      if (!shared || !alike) shared = instance(entry, *model, name, i + 1);
      world_.vehicles.push_back({entry.place, name, poses[static_cast<std::size_t>(i)], shared});
    }
  }

  /// Fills `file:` entries of the tree with what the files said.
  void resolve(ConfigNode& world_node) const {
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

 private:
  const ConfigNode* model_of(const VehicleEntry& entry, const std::string& who) {
    if (entry.file.empty()) return model_of_node(entry.model, who);
    const std::string path = find_file(entry.file, entry.place);
    if (path.empty()) {
      diagnostics_.error(entry.place, who,
                         "there is no vehicle file '" + entry.file + "' beside the world file or in ../vehicles");
      return nullptr;
    }
    auto [at, fresh] = files_.try_emplace(path);
    if (fresh) at->second = load_config_file(path, diagnostics_);
    return at->second.kind == ConfigNode::Kind::map ? &at->second : nullptr;
  }

  const ConfigNode* model_of_node(const ConfigNode& model, const std::string& who) {
    if (model.kind == ConfigNode::Kind::map) return &model;
    // An entry without a model at all was reported by the reader.
    if (model.place.file != nullptr) diagnostics_.error(model.place, who, "'model' must be a map, got " + shown(model));
    return nullptr;
  }

  std::shared_ptr<const VehicleConfig> instance(const VehicleEntry& entry, const ConfigNode& model,
                                                const std::string& name, int index) {
    const std::string who = "vehicle '" + name + "'";
    ConfigNode tree = model;
    for (const ConfigNode::Entry& change : entry.overrides.entries)
      set_config_path(tree, change.key, change.value, change.place, diagnostics_);
    const Parameters parameters = parameters_of(entry, model, who, index);
    substitute_parameters(tree, parameters, who, diagnostics_);
    auto config = std::make_shared<VehicleConfig>();
    ParamReader in(tree, who, diagnostics_);
    for (const char* kind : {"material", "category"}) declare_all(in, kind);
    config->read(in);
    in.finish();
    return config;
  }

  void declare_all(ParamReader& in, const char* kind) const {
    if (kind == std::string("material")) {
      in.declare(kind, "default");
      for (const MaterialConfig& material : world_.materials) in.declare(kind, material.name);
    } else {
      in.declare(kind, "solid");
      for (const std::string& category : world_.categories) in.declare(kind, category);
    }
  }

  Parameters parameters_of(const VehicleEntry& entry, const ConfigNode& model, const std::string& who, int index) {
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
        diagnostics_.error(given.place, who, "the vehicle has no parameter '" + given.key + "'");
        continue;
      }
      known->second = given.value;
      substitute_parameters(known->second, {parameters[0]}, who, diagnostics_);
    }
    return parameters;
  }

  WorldConfig& world_;
  Diagnostics& diagnostics_;
  std::map<std::string, ConfigNode> files_;
};

/// Materials, contacts and categories that vehicles bring.  The world's own contacts come after, so that they win.
void gather_from_vehicles(WorldConfig& world) {
  std::vector<MaterialConfig> materials;
  std::vector<ContactConfig> contacts;
  std::vector<std::string> categories;
  std::set<const VehicleConfig*> configs_seen;  // asked, never iterated
  std::set<std::string> materials_seen{"default"};
  std::set<std::string> categories_seen{"solid"};
  const auto add = [&](const auto& from, const std::vector<std::string>& own_categories) {
    for (const MaterialConfig& material : from.materials)
      if (materials_seen.insert(material.name).second) materials.push_back(material);
    for (const ContactConfig& contact : from.contacts)
      if (std::find(contacts.begin(), contacts.end(), contact) == contacts.end()) contacts.push_back(contact);
    for (const std::string& category : own_categories)
      if (categories_seen.insert(category).second) categories.push_back(category);
  };
  for (const VehicleInstance& vehicle : world.vehicles)
    if (configs_seen.insert(vehicle.config.get()).second) add(*vehicle.config, vehicle.config->categories);
  // Again, even where a vehicle said the same before: the last of equals wins.
  for (const ContactConfig& contact : world.contacts) std::erase(contacts, contact);
  add(world, world.categories);
  world.materials = std::move(materials);
  world.contacts = std::move(contacts);
  world.categories = std::move(categories);
}

void check_channels(const WorldConfig& world, Diagnostics& diagnostics) {
  std::set<std::string> taken;
  std::set<std::string> seen;
  for (const VehicleInstance& vehicle : world.vehicles)
    for (const DeviceConfig& device : vehicle.config->devices) {
      // Of two devices of one name, which the reader has reported, all channels would clash.
      if (device.device_type == nullptr || !seen.insert(vehicle.name + "/" + device.name).second) continue;
      const std::string who = "vehicle '" + vehicle.name + "': device '" + device.name + "'";
      const std::string report = device.channel.empty() ? channel_name(world.channels.report, vehicle.name, device.name)
                                                        : channel_name(device.channel, vehicle.name, device.name);
      for (const std::string& channel : {report, channel_name(world.channels.command, vehicle.name, device.name),
                                         channel_name(world.channels.truth, vehicle.name, device.name)}) {
        if (channel.empty() || channel.size() > Bus::max_channel_length)
          diagnostics.error(
              device.place, who,
              "a channel must have 1 to 63 characters, got " + std::to_string(channel.size()) + ": '" + channel + "'");
        else if (!taken.insert(channel).second)
          diagnostics.error(device.place, who, "channel '" + channel + "' is used twice");
        else if (channel.starts_with("sim."))
          diagnostics.error(device.place, who, "channel '" + channel + "' belongs to the simulator: sim.*");
      }
    }
}

/// `vehicles.NAME.devices.lidar.rate_hz` changes what is in the vehicle's file: it becomes one of its overrides.
bool set_override(ConfigNode& root, const std::string& path, const ConfigNode& value, const SourcePlace& place) {
  static const std::set<std::string> own_keys = {"name",  "file",      "model",      "position_m", "rpy_deg",
                                                 "count", "placement", "parameters", "overrides"};
  const std::size_t first = path.find('.');
  const std::size_t second = path.find('.', first + 1);
  if (path.rfind("vehicles.", 0) != 0 || second == std::string::npos) return false;
  const std::string name = path.substr(first + 1, second - first - 1);
  const std::string rest = path.substr(second + 1);
  ConfigNode* vehicles = root.find("vehicles");
  if (vehicles == nullptr || own_keys.contains(rest.substr(0, rest.find('.')))) return false;
  for (ConfigNode& vehicle : vehicles->items) {
    const ConfigNode* known = vehicle.find("name");
    if (known == nullptr || known->scalar != name || vehicle.kind != ConfigNode::Kind::map) continue;
    if (vehicle.find("overrides") == nullptr) {
      ConfigNode overrides;
      overrides.kind = ConfigNode::Kind::map;
      overrides.place = place;
      vehicle.entries.push_back({"overrides", place, overrides});
    }
    ConfigNode& overrides = *vehicle.find("overrides");
    std::erase_if(overrides.entries, [&](const ConfigNode::Entry& entry) { return entry.key == rest; });
    overrides.entries.push_back({rest, place, value});
    return true;
  }
  return false;
}

void apply_sets(ConfigNode& root, const LoadOptions& options, Diagnostics& diagnostics) {
  for (const std::string& set : options.sets) {
    const std::size_t equals = set.find('=');
    const SourcePlace place{intern_file_name("--set " + set), 0, 0};
    if (equals == std::string::npos || equals == 0) {
      diagnostics.error(place, "", "must be of the form path=value");
      continue;
    }
    ConfigNode value = parse_config_text(set.substr(equals + 1), *place.file, diagnostics);
    // Relative file names in the value still start at the world file.
    const std::string path = set.substr(0, equals);
    if (!set_override(root, path, value, place)) set_config_path(root, path, value, place, diagnostics);
  }
}

/// Why a plugin that a world names was not loaded; empty: it was, or `load_plugin` has said why not.
std::string plugin_problem(ConfigNode& item, const std::string& who, const LoadOptions& options,
                           Diagnostics& diagnostics) {
  const fs::path file = item.place.file != nullptr ? *item.place.file : "";
  const std::string path = find_plugin(item.scalar, file.parent_path().string());
  if (path.empty()) return "is neither beside this file nor in SHOAL_PLUGIN_PATH nor in lib/shoal/plugins";
  if (!options.allow_plugins && !is_loaded_plugin(path))
    return "a world file may run code only with --launch, or name the plugin with --plugin " + path;
  load_plugin(path, item.place, who, diagnostics);
  std::error_code error;
  if (const fs::path whole = fs::absolute(path, error); !error) item.scalar = whole.lexically_normal().string();
  return {};
}

/// Loads what `plugins:` names, before any device is read.  From then on the tree names them by their whole paths.
bool load_plugins(ConfigNode& root, const LoadOptions& options, Diagnostics& diagnostics) {
  const std::size_t before = diagnostics.lines().size();
  ConfigNode* plugins = root.find("plugins");
  if (plugins == nullptr) return true;
  for (ConfigNode& item : plugins->items) {
    if (item.kind != ConfigNode::Kind::scalar || is_loaded_plugin(item.scalar)) continue;
    const std::string who = "plugin '" + shortened(item.scalar) + "'";
    const std::string problem = plugin_problem(item, who, options, diagnostics);
    if (!problem.empty()) diagnostics.error(item.place, who, problem);
  }
  return diagnostics.lines().size() == before;
}

/// The resolved world may be written anywhere: mesh files are named by their whole path.
void make_mesh_paths_absolute(ConfigNode& node) {
  for (ConfigNode& item : node.items) make_mesh_paths_absolute(item);
  for (ConfigNode::Entry& entry : node.entries) {
    if (entry.key != "mesh" || entry.value.scalar.empty() || entry.value.place.file == nullptr) {
      make_mesh_paths_absolute(entry.value);
      continue;
    }
    std::error_code error;
    const fs::path path = fs::absolute(fs::path(*entry.value.place.file).parent_path() / entry.value.scalar, error);
    if (!error) entry.value.scalar = path.lexically_normal().string();
  }
}

LoadedWorld load(ConfigNode root, const SourcePlace& file, const LoadOptions& options, Diagnostics& diagnostics) {
  diagnostics.throw_if_any();
  LoadedWorld loaded;
  apply_sets(root, options, diagnostics);
  diagnostics.throw_if_any();
  ParamReader in(root, "", diagnostics);
  loaded.config.read(in);
  in.finish();
  // Its devices would all be of unknown types, which would bury the mistake.
  if (!load_plugins(root, options, diagnostics)) diagnostics.throw_if_any();
  if (options.seed) loaded.config.run.seed = *options.seed;
  if (loaded.config.name.empty() && file.file != nullptr) loaded.config.name = fs::path(*file.file).stem().string();
  VehicleLoader vehicles(loaded.config, diagnostics);
  for (const VehicleEntry& entry : loaded.config.vehicle_entries) vehicles.load(entry);
  check_channels(loaded.config, diagnostics);
  diagnostics.throw_if_any();
  gather_from_vehicles(loaded.config);
  vehicles.resolve(root);
  make_mesh_paths_absolute(root);
  if (options.seed) {
    const SourcePlace place{intern_file_name("--seed"), 0, 0};
    set_config_path(root, "run.seed", scalar_node(std::to_string(*options.seed), place), place, diagnostics);
  }
  loaded.resolved = std::move(root);
  return loaded;
}

}  // namespace

LoadedWorld load_world(const std::string& path, const LoadOptions& options) {
  Diagnostics diagnostics;
  ConfigNode root = load_config_file(path, diagnostics);
  return load(std::move(root), {intern_file_name(path), 0, 0}, options, diagnostics);
}

LoadedWorld load_world_text(const std::string& text, const std::string& file_name, const LoadOptions& options) {
  Diagnostics diagnostics;
  ConfigNode root = parse_config_text(text, file_name, diagnostics);
  return load(std::move(root), {intern_file_name(file_name), 0, 0}, options, diagnostics);
}

VehicleConfig load_vehicle(const std::string& path) {
  Diagnostics diagnostics;
  ConfigNode tree = load_config_file(path, diagnostics);
  diagnostics.throw_if_any();
  std::vector<std::pair<std::string, ConfigNode>> parameters;
  parameters.emplace_back("index", scalar_node("1", tree.place));
  parameters.emplace_back("name", scalar_node("vehicle", tree.place));
  if (const ConfigNode* defaults = tree.find("parameters"))
    for (const ConfigNode::Entry& each : defaults->entries) parameters.emplace_back(each.key, each.value);
  substitute_parameters(tree, parameters, "", diagnostics);
  VehicleConfig config;
  ParamReader in(tree, "", diagnostics);
  in.declare("material", "default");
  in.declare("category", "solid");
  config.read(in);
  in.finish();
  diagnostics.throw_if_any();
  return config;
}

}  // namespace sim
