// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/config/config_node.hpp"

namespace sim {

/// Kind of a YAML file, judged by its top-level keys.
enum class FileKind { world, vehicle, study, motion, declaration };

/// Kind of the file with this top level; a world when no key decides.
FileKind kind_of_file(const ConfigNode& root);

/// Throws ConfigError when the file is of another kind than `expected`, with the command for its own kind.  `file`: the
/// place of the file as a whole.
void require_file_kind(const ConfigNode& root, FileKind expected, const SourcePlace& file);

/// Returns what a file is instead of the expected kind, such as `a world, not a vehicle`; empty: it is of this kind,
/// cannot be read or parsed, or has no key that decides.  Reads at most 1 MB and no includes.
std::string other_kind(const std::string& path, FileKind expected);

}  // namespace sim
