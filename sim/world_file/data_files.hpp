// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <set>
#include <string>
#include <utility>

#include "sim/config/config_node.hpp"

namespace sim {

/// Returns the keys that name a file to be read (ParamKind::path, PathUse::read), each with the key of the map or list
/// that contains it: (`parts`, `mesh`), (`terrain`, `file`).  Includes the keys of the world, of vehicles and of all
/// registered devices.
std::set<std::pair<std::string, std::string>> data_file_keys();

/// Calls `visit` for each value of such a key below `root`, also in overrides and parameters of vehicles.  `named_in`:
/// the file to whose folder the path is relative; null: unknown.
void visit_data_files(ConfigNode& root,
                      const std::function<void(std::string& path, const std::string* named_in)>& visit);

/// Replaces the paths of those files by absolute paths, so that the tree can be written to any folder.
void make_paths_absolute(ConfigNode& root);

}  // namespace sim
