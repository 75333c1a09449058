// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <set>
#include <string>
#include <utility>

#include "sim/config/config_node.hpp"

namespace sim {

/// The keys that name a file that is read (ParamKind::path, PathUse::read), each with the key of the map or list it
/// stands in: (`parts`, `mesh`), (`terrain`, `file`).  Of the world, of vehicles and of every registered device.
std::set<std::pair<std::string, std::string>> data_file_keys();

/// Calls `visit` for each value below `root` that such a key names, also in overrides and as a parameter of a vehicle;
/// `named_in`: the file that it is relative to the folder of; null: unknown.
void visit_data_files(ConfigNode& root,
                      const std::function<void(std::string& path, const std::string* named_in)>& visit);

/// Names those files by their whole path, so that the tree may be written anywhere.
void make_paths_absolute(ConfigNode& root);

}  // namespace sim
