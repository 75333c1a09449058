// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace experiment {

/// Removes what an earlier run left in a results folder, except for its world.yaml: summary, figures, tracks, plots,
/// pages, branches, and the output of the programs that its world names.  Snapshots and records are kept.
void remove_earlier_run(const std::string& directory);

}  // namespace experiment
