#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/world/world_config.hpp"

namespace sim {

struct LoadOptions {
  std::vector<std::string> sets;      ///< `path=value`, as given with --set
  std::optional<std::int64_t> seed;   ///< instead of the file's
  bool allow_plugins = false;         ///< load the `plugins:` of the world, which then run code
  EncodeMessage encode_message = {};  ///< for events that publish messages
  bool special_files = false;         ///< the world may come from a pipe or a device; it cannot include others then
  /// Put the vehicle files into LoadedWorld::resolved; without them it has no vehicles, nor has `vehicle_entries`.
  bool resolve = true;
};

struct LoadedWorld {
  WorldConfig config;
  /// The world as it runs, with includes, vehicle files and --set applied: a world file of its own.
  ConfigNode resolved;
};

/// Reads and checks a world file and the vehicle files it names.  Throws ConfigError with every error found.
LoadedWorld load_world(const std::string& path, const LoadOptions& options = {});
/// The same from text.  `file_name` is used in messages, its directory to find vehicle files.
LoadedWorld load_world_text(const std::string& text, const std::string& file_name, const LoadOptions& options = {});
/// The same from a tree, whose errors are at the places that its nodes know.
LoadedWorld load_world_tree(ConfigNode root, const std::string& file_name, const LoadOptions& options = {});

/// Whether a key of `map` names a file of a mesh, a terrain, a texture or a current.  `map_key`: the key that the map
/// itself is the value of; empty: it is an item of a list.
bool names_data_file(const ConfigNode& map, const std::string& map_key, const std::string& key);
/// Names those files by their whole path, so that the tree may be written anywhere.
void make_paths_absolute(ConfigNode& node, const std::string& node_key = {});

}  // namespace sim
