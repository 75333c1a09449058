// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace bridges {

/// Settings of a community: those of its `.moos` file that stand before the blocks of the applications.
struct MoosFile {
  std::string path;  ///< for errors; empty: there is none
  std::string host = "localhost";
  int host_line = 0;
  int port = 9000;
  std::string community;
  std::optional<double> latitude_deg, longitude_deg;  ///< LatOrigin, LongOrigin: WGS84
  double time_warp = 1;                               ///< MOOSTimeWarp
};

/// Reads ServerHost, ServerPort, Community, LatOrigin, LongOrigin and MOOSTimeWarp; their case does not matter.
/// Comments start with `//`.  Throws sim::ConfigError with all errors.
MoosFile read_moos_text(const std::string& text, const std::string& path);
/// Does the same for a file of at most 1 MB: below the working folder, else below the shipped worlds.
MoosFile read_moos_file(const std::string& name);

/// Returns whether a host is this machine by its name or number: localhost, 127.x.x.x.
bool is_loopback(const std::string& host);

/// Returns the host of the MOOSDB: `peer`, which the command line names, else that of the file, which must be this
/// machine.  Throws sim::ConfigError.
std::string moos_host(const MoosFile& file, const std::string& peer);

/// Checks that the origins of a world and of a community are at most 1 m apart.  Throws sim::ConfigError.
void check_moos_origin(const MoosFile& file, const std::string& world, double latitude_deg, double longitude_deg);

}  // namespace bridges
