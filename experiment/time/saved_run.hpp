// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/bus/bus.hpp"

namespace experiment {

/// State of a run at one step: of its world, of its scores, and of the owners of its vehicles (SimService).
struct SavedRun {
  sim::Bytes state, scores, owners;
};

/// Returns the three as the sections of one archive, of which a SnapshotRing can take the difference part by part.
sim::Bytes joined(const SavedRun& saved);
/// Returns what joined() has joined.
SavedRun split(const sim::Bytes& bytes);

}  // namespace experiment
