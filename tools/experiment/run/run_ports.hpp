// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/bus/byte_port.hpp"
#include "tools/experiment/run/runner.hpp"

namespace tools {

/// The folder of a run without results for its serial ports: `shoal-USER/WORLD` in the folder for temporary files,
/// USER a number.  The first part belongs to this user alone; the second may not exist yet.
struct PortFolder {
  std::string folder, world;
};
/// Throws std::runtime_error when the folder belongs to another user.
PortFolder temporary_port_folder(const std::string& world_name);

/// Opens the serial ports of a run.  A relative path lies below `serial` in the results, else below
/// temporary_port_folder(); an absolute one below a folder that the command line allows, or anywhere when the world may
/// name any file.  Says where each port is.
sim::PortOpener serial_ports_of(const sim::WorldConfig& world, const RunOptions& options);

}  // namespace tools
