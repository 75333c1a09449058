// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "experiment/run/runner.hpp"
#include "sim/world_file/load_world.hpp"

namespace tools {

/// Interface of the library `page` for `shoal run --view`.
struct LivePage {
  /// Returns the function that starts the page of a run; `view` must outlive it.  It throws bridges::WebError, and
  /// sim::ConfigError for the profile.
  experiment::RunPage::Make (*page)(const experiment::ViewOptions& view);
  /// Runs a world each time that one of its files was saved, until a signal, and shows its errors on the page (`shoal
  /// run --view --watch`).  All runs have the same address.  `load` reads the world; `go` runs it and returns an exit
  /// code.  Returns the exit code of the last run, or 2 after an error of the world.
  int (*run_watched)(const std::string& world_file, experiment::RunOptions& options, experiment::ViewOptions& view,
                     const std::function<sim::LoadedWorld()>& load,
                     const std::function<int(const sim::LoadedWorld&)>& go);
};

/// The library sets it when it is loaded.
inline const LivePage* live_page = nullptr;

}  // namespace tools
