// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/config/warnings.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

struct LoadOptions {
  std::vector<std::string> sets;  ///< `path=value`, as given with --set
  /// The same of a study file, applied after `sets`: they may name only the files that the world may.
  std::vector<std::string> study_sets = {};
  std::optional<std::int64_t> seed;   ///< seed instead of that of the file
  bool allow_plugins = false;         ///< load the `plugins:` of the world, which execute code
  EncodeMessage encode_message = {};  ///< for events that publish messages
  /// Treats the world as untrusted: the files that it names must lie below its folder, the folder `vehicles` beside it
  /// or the shipped folders, and its buses must be local to this machine unless `allow_plugins`.
  bool only_own_files = false;
  std::vector<std::string> allow_paths = {};  ///< further allowed folders and files
  bool serial_ports = true;                   ///< serial ports are opened, and their paths are checked
  bool special_files = false;    ///< the world may be read from a pipe or a device; it then cannot include files
  Warnings* warnings = nullptr;  ///< shared by several worlds, so that common warnings are logged once; null: separate
  /// Insert the vehicle files into LoadedWorld::resolved; otherwise it and `vehicle_entries` have no vehicles.
  bool resolve = true;
  /// Duration of the run instead of that of the file, 0: unlimited.  Warnings apply to what comes after both.
  std::optional<double> duration_s = {};
};

/// Returns the rules for files that a world (or vehicle) in `world_file` may name; null: any file.
FileAccessPointer files_of(const std::string& world_file, const LoadOptions& options);

struct LoadedWorld {
  WorldConfig config;
  /// The effective world, with includes, vehicle files and --set applied; a complete world file.
  ConfigNode resolved;
};

/// Reads and checks a world file and the vehicle files that it names.  Throws ConfigError with all errors found.
LoadedWorld load_world(const std::string& path, const LoadOptions& options = {});
/// Reads a world from text.  `file_name` is used in messages, and its folder for finding vehicle files.
LoadedWorld load_world_text(const std::string& text, const std::string& file_name, const LoadOptions& options = {});
/// Reads a world from a tree; errors are reported at the places of its nodes.
LoadedWorld load_world_tree(ConfigNode root, const std::string& file_name, const LoadOptions& options = {});

}  // namespace sim
