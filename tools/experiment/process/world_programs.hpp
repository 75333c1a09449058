// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/program/program_declaration.hpp"
#include "sim/world_file/load_world.hpp"

namespace tools {

/// Where the programs of a world are looked up.
struct ProgramLookup {
  bool all_needed = true;                 ///< a `program:` without a declaration is an error, else it is left out
  std::vector<std::string> allow_paths;   ///< folders that the command line allows, after that of the running program
  std::vector<std::string> folders = {};  ///< the folder of the running program and those of PATH; empty: the real ones
};

/// Checks the `args:` of the processes of a world by the declarations of their programs, and makes their commands of
/// them.  Reads declarations only, and never starts a program.  Throws sim::ConfigError with every error found.
void read_programs(sim::LoadedWorld& loaded, const ProgramLookup& lookup);

/// A process as the file of its world writes it.
struct WrittenProcess {
  sim::SourcePlace place;                 ///< where its program is named
  std::string program;                    ///< empty: it has a `command`
  const sim::ConfigNode* args = nullptr;  ///< never null for a `program`; lives as long as the world
};
WrittenProcess written_process(const sim::LoadedWorld& loaded, std::size_t index);

}  // namespace tools
