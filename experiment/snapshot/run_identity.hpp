// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/config/config_node.hpp"
#include "sim/world_file/load_world.hpp"

namespace experiment {

/// Returns what determines the last bits of a result besides versions: processor class and C library, such as
/// `x86-64-v3, glibc 2.36`.
std::string build_text();

/// Returns the files of meshes, terrain, textures and currents that a resolved world names, a line `HASH PATH` for
/// each, by path.  A file that cannot be read has 16 dashes.
std::string files_text(const sim::ConfigNode& resolved);

/// Returns a line for each file of `text` (from files_text) that is missing now, or has changed.
std::vector<std::string> changed_files(const std::string& text);

/// Permits a world of a record or snapshot to name the unchanged files of such a list, because the author of the list
/// had access to their content.
void allow_files(const std::string& text, sim::LoadOptions& load);

}  // namespace experiment
