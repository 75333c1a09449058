// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bridges/base/file_descriptor.hpp"
#include "sim/config/config_node.hpp"

namespace experiment {

/// Returns one line: that results cannot be written there, the reason by `error_number` (of errno), and for a full disk
/// or a folder that cannot be written what to do.
std::string cannot_write_text(const std::string& path, int error_number);

/// Lock of a results folder against other runs while this one writes there.  It is released when the process ends.
class ResultsLock {
 public:
  /// Creates and locks the folder.  Throws RunError when another run holds the lock or the folder cannot be created.
  explicit ResultsLock(const std::string& directory);

 private:
  bridges::FileDescriptor folder_;
};

/// Removes what an earlier run left in a results folder, except for its world.yaml: summary, figures, tracks, plots,
/// pages, branches, and the output of the programs that its world names.  Snapshots and records are kept.
void remove_earlier_run(const std::string& directory);

/// Writes DIRECTORY/world.yaml.  A run does so before its first step, so that the file exists even when the run is
/// killed. Throws std::runtime_error.
void write_results_world(const std::string& directory, const sim::ConfigNode& resolved);

}  // namespace experiment
