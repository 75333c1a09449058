// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace experiment {

/// Program of others that a part of Shoal starts.  Everything else works without it.
struct HelperProgram {
  const char* name;
  const char* package;  ///< of Debian 12, Debian 13 and Ubuntu 24.04
  const char* purpose;  ///< what does not work without it
};

/// Returns those that this system does not have.  `has`: whether there is a program of this name.
std::vector<HelperProgram> missing_helpers(const std::function<bool(const std::string&)>& has);

/// Returns the command that installs packages, to be run as root, on the system with these contents of
/// /etc/os-release; on a system without apt a sentence that names the programs.
std::string install_command(const std::vector<HelperProgram>& programs, const std::string& os_release);

}  // namespace experiment
