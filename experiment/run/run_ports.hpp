// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "experiment/run/runner.hpp"
#include "sim/bus/byte_port.hpp"

namespace experiment {

/// Folder for the serial ports of a run without results: `shoal-USER/WORLD` in the folder for temporary files, where
/// USER is a number.  The first part belongs to this user only; the second may not exist yet.
struct PortFolder {
  std::string folder, world;
};
/// Returns the folder.  Throws std::runtime_error when it belongs to another user.
PortFolder temporary_port_folder(const std::string& world_name);

/// Opens the serial ports of a run.  A relative path is resolved below `serial` in the results, else below
/// temporary_port_folder(); an absolute one must be below a folder that the command line allows, unless the world may
/// name any file.  Prints the path of each port.
sim::PortOpener serial_ports_of(const sim::WorldConfig& world, const RunOptions& options);

/// Replaces `{run}` in a text by the name of the run, so that concurrent runs do not share a path.
inline std::string with_run_name(std::string text, const std::string& name) {
  static constexpr char key[] = "{run}";
  for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + name.size()))
    text.replace(at, sizeof key - 1, name);
  return text;
}

}  // namespace experiment
