// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "sim/world_file/load_world.hpp"
#include "tools/experiment/run/runner.hpp"

namespace tools {

/// Runs a world each time that one of its files was saved, until a signal, and shows its errors on the live page
/// (`shoal run --view --watch`).  All runs have the same address.
///
/// `load` reads the world; `go` runs it and returns an exit code.  `options.view` must be set.  Returns the exit code
/// of the last run, or 2 after an error of the world.
int run_watched(const std::string& world_file, RunOptions& options, const std::function<sim::LoadedWorld()>& load,
                const std::function<int(const sim::LoadedWorld&)>& go);

}  // namespace tools
