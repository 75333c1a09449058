// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/saved_scores.hpp"

namespace experiment {

std::string restore_scores(Scoring& scoring, const sim::Bytes& saved) {
  try {
    auto scores = sim::StateArchive::restorer(saved);
    scoring.visit_state(scores, History::whole);
    scores.end();
  } catch (const sim::SnapshotError& error) {
    return std::string("the scores begin with the log: ") + error.what();
  }
  return {};
}

}  // namespace experiment
