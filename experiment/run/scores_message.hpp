// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "experiment/score/scoring.hpp"
#include "shoal/sim_scores_t.hpp"

namespace experiment {

/// Fills in the present figures of all metrics and the outcomes of the rules; not the time.
void fill_scores(const Scoring& scoring, shoal::sim_scores_t& message);

}  // namespace experiment
