// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

namespace tools {

/// A YAML file that came with the program.
struct ShippedFile {
  std::string name;         ///< without folder and ending
  std::string path;         ///< of the file
  std::string description;  ///< its `description:`; empty: it has none
};

/// The kinds of files that come with the program.
enum class ShippedKind { world, vehicle, study };

/// Every file of a kind, by name.  None when the program finds no shipped files (sim::shipped_folder()).
std::vector<ShippedFile> shipped_files(ShippedKind kind);

/// The file that a command line means by `given`: a file of that name, else NAME.yaml here, else the shipped one of
/// this name, which may also be given as `worlds/NAME.yaml`.  Another path is returned unchanged, also when there is no
/// such file.  Throws sim::ConfigError when a bare name means nothing.
/// Of several kinds the first that has the name counts.
std::string file_by_name(std::initializer_list<ShippedKind> kinds, const std::string& given);
inline std::string world_file(const std::string& given) {
  return file_by_name({ShippedKind::world}, given);
}

}  // namespace tools
