// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "sim/program/program_declaration.hpp"
#include "sim/world_file/load_world.hpp"

namespace experiment {

/// Folders in which the programs of a world are looked up.
struct ProgramLookup {
  bool all_needed = true;                 ///< a `program:` without a declaration is an error, else it is left out
  std::vector<std::string> allow_paths;   ///< folders that the command line allows, besides that of the running program
  std::vector<std::string> folders = {};  ///< the folder of the running program and those of PATH; empty: the actual
                                          ///< ones
};

/// Checks the `args:` of the processes of a world against the declarations of their programs, and builds their
/// commands. Reads only declarations, and never starts a program.  Throws sim::ConfigError with all errors.
void read_programs(sim::LoadedWorld& loaded, const ProgramLookup& lookup);

/// Process or bridge as written in the world file.
struct WrittenProcess {
  bool is_bridge = false;
  sim::SourcePlace place;                 ///< where its program is named
  std::string program;                    ///< empty: it has a `command`
  const sim::ConfigNode* args = nullptr;  ///< never null for a `program`; lives as long as the world
};
/// Returns entry `index` of the world's processes, which end with its bridges.
WrittenProcess written_process(const sim::LoadedWorld& loaded, std::size_t index);

/// Returns the names of the bridges that run freely, so that a run with them is not repeatable.
std::vector<std::string> free_bridges(const sim::LoadedWorld& loaded);

}  // namespace experiment
