// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

namespace experiment {

/// YAML file that comes with the program.
struct ShippedFile {
  std::string name;         ///< without extension, and without folder except in `benchmark/NAME`
  std::string path;         ///< of the file
  std::string description;  ///< its `description:`; empty: it has none
};

/// Kind of file that comes with the program.
enum class ShippedKind { world, vehicle, study };

/// Returns all files of a kind, by name.  None when the program finds no shipped files (sim::shipped_folder()).
std::vector<ShippedFile> shipped_files(ShippedKind kind);

/// Resolves a file name of a command line: a file of the name `given`, else NAME.yaml in the current folder, else the
/// shipped file of this name, which may also be given as `NAME.yaml` or `worlds/NAME.yaml`; a folder `given` does not
/// hide it.  Another path is returned unchanged, even when no such file exists.  Throws sim::ConfigError when a bare
/// name matches nothing.  Of several kinds the first one with this name is used.
std::string file_by_name(std::initializer_list<ShippedKind> kinds, const std::string& given);
inline std::string world_file(const std::string& given) {
  return file_by_name({ShippedKind::world}, given);
}

}  // namespace experiment
