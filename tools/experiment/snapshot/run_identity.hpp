// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/config/config_node.hpp"
#include "sim/world_file/load_world.hpp"

namespace tools {

/// What decides the last bits of a result beside versions: processor class and C library, such as
/// `x86-64-v3, glibc 2.36`.
std::string build_text();

/// The files of meshes, terrain, textures and currents that a resolved world names, a line `HASH PATH` for each, by
/// path.  A file that cannot be read has 16 dashes.
std::string files_text(const sim::ConfigNode& resolved);

/// A line for each file of `text` (from files_text) that does not exist now, or is another one.
std::vector<std::string> changed_files(const std::string& text);

/// Lets a world of a record or snapshot name the files of such a list that are as they were: whoever wrote the list
/// knew what is in them.
void allow_files(const std::string& text, sim::LoadOptions& load);

}  // namespace tools
