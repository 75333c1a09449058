// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "experiment/score/scoring.hpp"
#include "sim/state/state_archive.hpp"

namespace experiment {

/// Continues scores from those of the snapshot with which a record begins.  Returns why that is not possible, and the
/// scores begin with the log; empty: they continue.
std::string restore_scores(Scoring& scoring, const sim::Bytes& saved);

}  // namespace experiment
