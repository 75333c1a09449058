// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "experiment/study/study_runs.hpp"

namespace experiment {

/// Cases of a study with equal results.
struct EqualCases {
  std::vector<std::string> cases;  ///< two or more, as the study orders them
  bool same_settings = false;      ///< they change the same settings; otherwise a setting has no effect
  bool same_state = false;         ///< the final states are equal, too
};

/// Groups of cases whose runs have the same figures for every seed or, where a world has no figures, the same final
/// state.  A case with a run without a result is in no group.
std::vector<EqualCases> equal_cases(const LoadedStudy& study, const std::vector<StudyRun>& runs);

/// Returns a readable sentence about a group.
std::string equal_cases_text(const EqualCases& group);

}  // namespace experiment
