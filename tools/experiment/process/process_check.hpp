// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/config/warnings.hpp"
#include "sim/world_file/load_world.hpp"

namespace tools {

/// Warns of programs of a world that cannot do what they are there for, as far as their command lines say it: slots
/// that overlap, somebody to follow who is not there or never sends, a name in the lockstep that is another, metrics of
/// channels on which none of them speaks.  Only programs that come with Shoal are known.
void warn_of_processes(const sim::LoadedWorld& loaded, sim::Warnings& warnings);

/// Warns of programs that cannot be started: they are neither beside the running program nor in PATH.
void warn_of_missing_programs(const sim::LoadedWorld& loaded, sim::Warnings& warnings);

}  // namespace tools
