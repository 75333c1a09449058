// SPDX-License-Identifier: BSD-3-Clause
#include "sim/world_file/load_world.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "sim/base/number.hpp"
#include "sim/bus/bus.hpp"
#include "sim/config/file_access.hpp"
#include "sim/config/message_text.hpp"
#include "sim/device/device_registry.hpp"
#include "sim/device/plugin.hpp"
#include "sim/world_file/check_script.hpp"
#include "sim/world_file/config_warnings.hpp"
#include "sim/world_file/data_files.hpp"
#include "sim/world_file/file_kind.hpp"
#include "sim/world_file/vehicle_loader.hpp"

namespace sim {

namespace {

namespace fs = std::filesystem;

/// Collects materials, contacts and categories of the vehicles.  The contacts of the world follow, and take precedence.
void gather_from_vehicles(WorldConfig& world) {
  std::vector<MaterialConfig> materials;
  std::vector<ContactConfig> contacts;
  std::vector<std::string> categories;
  std::set<const VehicleConfig*> configs_seen;  // for look-ups, never iterated
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
  // Add them again even when a vehicle has equal ones: the last one takes precedence.
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
      // Skip two devices of one name, which the reader has reported: all their channels would conflict.
      if (device.device_type == nullptr || !seen.insert(vehicle.name + "/" + device.name).second) continue;
      const std::string who = "vehicle '" + vehicle.name + "': device '" + device.name + "'";
      for (const ChannelKind kind : all_channel_kinds) {
        const std::string channel = device_channel(world.channels, vehicle.name, device, kind);
        const std::string error = channel_error(channel, taken.contains(channel));
        if (!error.empty()) diagnostics.error(device.place, who, error);
        taken.insert(channel);
      }
    }
}

/// Returns whether a key belongs to an entry of `vehicles:`; every other key of a path is in the vehicle file.
bool is_key_of_entry(const std::string& key) {
  static const std::set<std::string> own_keys = {"name",  "file",      "model",      "position_m", "rpy_deg",
                                                 "count", "placement", "parameters", "overrides",  "bus"};
  return own_keys.contains(key);
}

const std::string& text_at(const ConfigNode& map, const char* key) {
  static const std::string nothing;
  const ConfigNode* value = map.find(key);
  return value != nullptr ? value->scalar : nothing;
}

/// Returns whether `name` is NAME7 of an entry NAME with a `count` of 7 or more.
bool is_one_of_count(const ConfigNode& entry, const std::string& name) {
  const std::string& stem = text_at(entry, "name");
  const std::string& count = text_at(entry, "count");
  if (stem.empty() || !name.starts_with(stem) || name.size() == stem.size() || name[stem.size()] == '0') return false;
  const int index = exact_number<int>(std::string_view(name).substr(stem.size())).value_or(0);
  const int max = exact_number<int>(count).value_or(0);
  return max > 1 && index >= 1 && index <= max;
}

void add_override(ConfigNode& vehicle, const std::string& key, const ConfigNode& value, const SourcePlace& place) {
  if (vehicle.find("overrides") == nullptr) {
    ConfigNode overrides;
    overrides.kind = ConfigNode::Kind::map;
    overrides.place = place;
    vehicle.entries.push_back({"overrides", place, overrides});
  }
  ConfigNode& overrides = *vehicle.find("overrides");
  std::erase_if(overrides.entries, [&](const ConfigNode::Entry& entry) { return entry.key == key; });
  overrides.entries.push_back({key, place, value});
}

/// Converts a path into the vehicle file, such as `vehicles.NAME.devices.lidar.rate_hz`, to an override of the entry,
/// even when NAME is one vehicle of a `count`.
bool set_override(ConfigNode& root, const std::string& path, const ConfigNode& value, const SourcePlace& place,
                  Diagnostics& diagnostics) {
  const std::size_t first = path.find('.');
  const std::size_t second = path.find('.', first + 1);
  if (path.rfind("vehicles.", 0) != 0 || second == std::string::npos) return false;
  const std::string name = path.substr(first + 1, second - first - 1);
  const std::string rest = path.substr(second + 1);
  const std::string key = rest.substr(0, rest.find('.'));
  ConfigNode* vehicles = root.find("vehicles");
  if (vehicles == nullptr) return false;
  for (ConfigNode& vehicle : vehicles->items) {
    if (text_at(vehicle, "name") != name || vehicle.kind != ConfigNode::Kind::map) continue;
    if (is_key_of_entry(key)) return false;
    add_override(vehicle, rest, value, place);
    return true;
  }
  for (ConfigNode& vehicle : vehicles->items) {
    if (!is_one_of_count(vehicle, name)) continue;
    if (is_key_of_entry(key))
      diagnostics.error(place, "vehicle '" + name + "'",
                        "'" + key + "' belongs to all vehicles of the 'count' of '" + text_at(vehicle, "name") +
                            "'; for one of them only keys of the vehicle file can be set");
    else
      add_override(vehicle, name + "/" + rest, value, place);
    return true;
  }
  return false;
}

void apply_sets(ConfigNode& root, const std::vector<std::string>& sets, Origin origin, Diagnostics& diagnostics) {
  for (const std::string& set : sets) {
    const std::size_t equals = set.find('=');
    const SourcePlace place{intern_file_name("--set " + shortened(set, 240)), 0, 0};
    if (equals == std::string::npos || equals == 0) {
      diagnostics.error(place, "", "must be of the form path=value");
      continue;
    }
    ConfigNode value = parse_config_text(set.substr(equals + 1), *place.file, diagnostics);
    set_origin(value, origin);
    // Relative file names in the value are relative to the world file.
    const std::string path = set.substr(0, equals);
    if (!set_override(root, path, value, place, diagnostics)) set_config_path(root, path, value, place, diagnostics);
  }
}

/// Loads a plugin named by a world; returns the reason of a failure, empty on success or when `load_plugin` has
/// reported it.
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

/// Loads the plugins in `plugins:`, before any device is read, and replaces their names in the tree by absolute paths.
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

/// Warns once that hydrodynamic coefficients have no effect in a world without water.
void warn_of_missing_water(const WorldConfig& world, Warnings& warnings) {
  if (world.medium.water) return;
  std::vector<std::pair<std::string, SourcePlace>> dry;
  for (const VehicleInstance& vehicle : world.vehicles)
    if (vehicle.config->has_coefficients()) dry.emplace_back("vehicle '" + vehicle.name + "'", vehicle.place);
  for (const ObjectConfig& object : world.objects)
    if (object.has_coefficients()) dry.emplace_back("object '" + object.name + "'", object.place);
  if (dry.empty()) return;
  const std::string more = dry.size() == 1 ? "" : fmt::format(" (and {} more)", dry.size() - 1);
  warnings.warn(dry.front().second, dry.front().first + more,
                "it has hydrodynamics, but the world has no 'medium: water:', so it will fall freely");
}

/// Checks that the weight of water is positive: otherwise the direction of hydrostatic forces would be reversed.
void check_weight_of_water(const WorldConfig& world, const ConfigNode& root, Diagnostics& diagnostics) {
  if (!world.medium.water || world.physics.gravity_mps2 >= 0) return;
  const ConfigNode* physics = root.find("physics");
  const ConfigNode* gravity = physics != nullptr ? physics->find("gravity_mps2") : nullptr;
  diagnostics.error(
      gravity != nullptr ? gravity->place : root.place, "physics",
      "'gravity_mps2' must be 0 or more in a world with water, got " + number_text(world.physics.gravity_mps2));
}

/// Checks that the ends of `links:` are vehicles of the file, or their devices.
void check_acoustic_links(const WorldConfig& world, const ConfigNode& root, Diagnostics& diagnostics) {
  const ConfigNode* acoustics = root.find("acoustics");
  const ConfigNode* links = acoustics != nullptr ? acoustics->find("links") : nullptr;
  if (links == nullptr) return;
  for (std::size_t i = 0; i < links->items.size(); ++i)
    for (const char* key : {"from", "to"}) {
      const ConfigNode* end = links->items[i].find(key);
      if (end == nullptr || end->scalar.empty()) continue;
      const std::size_t slash = end->scalar.find('/');
      const auto found = std::find_if(world.vehicles.begin(), world.vehicles.end(), [&](const VehicleInstance& each) {
        return each.name == end->scalar.substr(0, slash);
      });
      const std::string who = "acoustics: links: link " + std::to_string(i + 1);
      if (found == world.vehicles.end()) {
        diagnostics.error(end->place, who,
                          "'" + std::string(key) + "' names no vehicle '" + end->scalar.substr(0, slash) + "'");
      } else if (slash != std::string::npos) {
        const auto& devices = found->config->devices;
        if (std::none_of(devices.begin(), devices.end(),
                         [&](const DeviceConfig& device) { return device.name == end->scalar.substr(slash + 1); }))
          diagnostics.error(end->place, who, "'" + std::string(key) + "' names no device '" + end->scalar + "'");
      }
    }
}

/// Returns the keys of the top level of world and vehicle files.
std::set<std::string> known_keys() {
  std::vector<ParamInfo> table;
  ParamReader in(table);
  WorldConfig().read(in);
  VehicleConfig().read(in);
  std::set<std::string> keys{"include"};
  for (const ParamInfo& info : table) keys.insert(info.key);
  return keys;
}

bool is_local_only(const std::string& url) {
  if (url.starts_with("memq:")) return true;
  const std::size_t ttl = url.find("ttl=");
  // LCM uses the last of several values.
  return url.starts_with("udpm:") && (ttl == std::string::npos || (url.substr(ttl, 5) == "ttl=0" &&
                                                                   (ttl + 5 == url.size() || url[ttl + 5] == '&') &&
                                                                   url.find("ttl=", ttl + 1) == std::string::npos));
}

/// Checks the URLs of buses, because LCM URLs can also write files and reach other machines.
void check_buses(const WorldConfig& world, const ConfigNode& root, const LoadOptions& options,
                 Diagnostics& diagnostics) {
  const ConfigNode* list = root.find("buses");
  for (std::size_t i = 0; list != nullptr && i < world.buses.size() && i < list->items.size(); ++i) {
    const ConfigNode* url = list->items[i].find("lcm_url");
    if (url == nullptr || url->place.origin == Origin::command_line) continue;
    const std::string who = "bus '" + world.buses[i].name + "'";
    if (url->scalar.starts_with("file:"))
      diagnostics.error(url->place, who, "'lcm_url' must be the URL of a network, got a file");
    else if (options.only_own_files && !options.allow_plugins && !is_local_only(url->scalar))
      diagnostics.error(url->place, who,
                        "'lcm_url' must stay on this machine (udpm:// with ttl=0, memq://); one that leaves it needs "
                        "--launch or --set buses." +
                            world.buses[i].name + ".lcm_url=" + shortened(url->scalar));
  }
}

LoadedWorld load(ConfigNode root, const SourcePlace& file, const LoadOptions& options, Diagnostics& diagnostics) {
  diagnostics.throw_if_any();
  require_file_kind(root, FileKind::world, file);
  LoadedWorld loaded;
  loaded.config.encode_message = options.encode_message;
  loaded.config.files = diagnostics.files();
  apply_sets(root, options.sets, Origin::command_line, diagnostics);
  apply_sets(root, options.study_sets, Origin::file, diagnostics);
  diagnostics.throw_if_any();
  // Read the keys of the world.
  ParamReader in(root, "", diagnostics);
  loaded.config.read(in);
  in.finish();
  check_weight_of_water(loaded.config, root, diagnostics);
  check_buses(loaded.config, root, options, diagnostics);
  // All its devices would have unknown types, which would obscure the error.
  if (!load_plugins(root, options, diagnostics)) diagnostics.throw_if_any();
  // Apply file name, seed and name.
  if (file.file != nullptr) loaded.config.file = *file.file;
  if (options.seed) loaded.config.run.seed = *options.seed;
  if (loaded.config.name.empty() && file.file != nullptr) loaded.config.name = fs::path(*file.file).stem().string();
  // Load the vehicles.
  VehicleLoader vehicles(loaded.config, diagnostics);
  for (const VehicleEntry& entry : loaded.config.vehicle_entries)
    for (VehicleInstance& instance : vehicles.load(entry)) loaded.config.vehicles.push_back(std::move(instance));
  // Check references between parts of the world.
  check_channels(loaded.config, diagnostics);
  check_metrics(loaded.config, diagnostics);
  check_acoustic_links(loaded.config, root, diagnostics);
  diagnostics.throw_if_any();
  gather_from_vehicles(loaded.config);
  check_script(loaded.config, diagnostics);
  diagnostics.throw_if_any();
  // Warn of settings without effect.
  Warnings own_warnings;
  Warnings& warnings = options.warnings != nullptr ? *options.warnings : own_warnings;
  warn_of_missing_water(loaded.config, warnings);
  warn_of_config(loaded.config, root, warnings, options.duration_s);
  // Make the resolved world.
  if (options.resolve) vehicles.resolve(root);
  make_paths_absolute(root);
  if (options.seed) {
    const SourcePlace place{intern_file_name("--seed"), 0, 0};
    set_config_path(root, "run.seed", scalar_node(std::to_string(*options.seed), place), place, diagnostics);
  }
  if (!options.resolve) {  // the instances contain the configurations of the vehicles
    if (ConfigNode* vehicles_node = root.find("vehicles")) *vehicles_node = {};
    std::vector<VehicleEntry>().swap(loaded.config.vehicle_entries);  // also releases the memory
  }
  loaded.resolved = std::move(root);
  return loaded;
}

}  // namespace

FileAccessPointer files_of(const std::string& world_file, const LoadOptions& options) {
  if (!options.only_own_files) return nullptr;
  const fs::path folder = fs::path(world_file).parent_path();
  std::vector<std::string> folders{folder.string(), (folder / ".." / "vehicles").string()};
  if (!shipped_folder().empty())
    for (const char* shipped : {"worlds", "vehicles"}) folders.push_back(shipped_folder() + "/" + shipped);
  auto files = std::make_shared<FileAccess>(std::move(folders), options.allow_paths, known_keys());
  if (!options.serial_ports) files->ignore_ports();
  return files;
}

namespace {

/// Returns the whole contents of a pipe or device.
std::string text_of(const std::string& path) {
  constexpr std::size_t max_world_bytes = std::size_t{64} << 20;
  const SourcePlace place{intern_file_name(path), 0, 0};
  std::ifstream in(path, std::ios::binary);
  if (!in) throw_config_error(place, "", "cannot read the file");
  std::string text;
  char block[1 << 16];
  while (in && text.size() <= max_world_bytes) {
    in.read(block, sizeof block);
    text.append(block, static_cast<std::size_t>(in.gcount()));
  }
  if (text.size() > max_world_bytes) throw_config_error(place, "", "the file is larger than 64 MB");
  return text;
}

}  // namespace

LoadedWorld load_world(const std::string& path, const LoadOptions& options) {
  Diagnostics diagnostics(files_of(path, options));
  std::error_code ignored;
  if (options.special_files && !fs::is_regular_file(path, ignored) && !fs::is_directory(path, ignored))
    return load_world_text(text_of(path), path, options);
  ConfigNode root = load_config_file(path, diagnostics);
  return load(std::move(root), {intern_file_name(path), 0, 0}, options, diagnostics);
}

LoadedWorld load_world_text(const std::string& text, const std::string& file_name, const LoadOptions& options) {
  Diagnostics diagnostics(files_of(file_name, options));
  ConfigNode root = parse_config_text(text, file_name, diagnostics);
  return load(std::move(root), {intern_file_name(file_name), 0, 0}, options, diagnostics);
}

LoadedWorld load_world_tree(ConfigNode root, const std::string& file_name, const LoadOptions& options) {
  Diagnostics diagnostics(files_of(file_name, options));
  return load(std::move(root), {intern_file_name(file_name), 0, 0}, options, diagnostics);
}

}  // namespace sim
