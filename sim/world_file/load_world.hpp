// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/config/warnings.hpp"
#include "sim/world_file/world_config.hpp"

namespace sim {

struct LoadOptions {
  std::vector<std::string> sets;      ///< `path=value`, as given with --set
  std::optional<std::int64_t> seed;   ///< instead of the file's
  bool allow_plugins = false;         ///< load the `plugins:` of the world, which then run code
  EncodeMessage encode_message = {};  ///< for events that publish messages
  /// The world may be untrusted: the files that it names must lie below its folder, the folder `vehicles` beside
  /// that or the shipped ones, and its buses must stay on this machine unless `allow_plugins`.
  bool only_own_files = false;
  std::vector<std::string> allow_paths = {};  ///< further folders and files
  bool serial_ports = true;                   ///< they are opened: their paths count
  bool special_files = false;    ///< the world may come from a pipe or a device; it cannot include others then
  Warnings* warnings = nullptr;  ///< of several worlds, so that what is wrong in all is logged once; null: of its own
  /// Put the vehicle files into LoadedWorld::resolved; without them it has no vehicles, nor has `vehicle_entries`.
  bool resolve = true;
  /// Duration of the run instead of the file's, 0: without end.  Warnings are of what comes after both.
  std::optional<double> duration_s = {};
};

/// Which files a world (or vehicle) in `world_file` may name; null: any.
FileAccessPointer files_of(const std::string& world_file, const LoadOptions& options);

struct LoadedWorld {
  WorldConfig config;
  /// The world as it runs, with includes, vehicle files and --set applied: its own world file.
  ConfigNode resolved;
};

/// Reads and checks a world file and the vehicle files it names.  Throws ConfigError with every error found.
LoadedWorld load_world(const std::string& path, const LoadOptions& options = {});
/// The same from text.  `file_name` is used in messages, its directory to find vehicle files.
LoadedWorld load_world_text(const std::string& text, const std::string& file_name, const LoadOptions& options = {});
/// The same from a tree; errors are at the places of its nodes.
LoadedWorld load_world_tree(ConfigNode root, const std::string& file_name, const LoadOptions& options = {});

}  // namespace sim
