// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>

#include "experiment/study/study_results.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {

namespace {

using Metrics = std::map<std::string, std::optional<double>>;

/// Results of the runs of a case, in the order of the seeds.
struct Outcome {
  std::vector<std::string> hashes;
  std::vector<Metrics> figures;
  bool has_figures = false;

  bool is_like(const Outcome& other) const {
    return figures == other.figures && (has_figures || hashes == other.hashes);
  }
};

/// Returns std::nullopt when a run has no result.
std::optional<Outcome> outcome_of(std::size_t in_case, const std::vector<StudyRun>& runs) {
  Outcome outcome;
  for (const StudyRun& run : runs) {
    if (run.in_case != in_case) continue;
    if (!run.record) return std::nullopt;
    outcome.hashes.push_back(run.record->run_hash);
    outcome.figures.push_back(run.record->metrics);
    for (const auto& [name, value] : run.record->metrics) outcome.has_figures |= value.has_value();
  }
  return outcome;
}

}  // namespace

std::vector<EqualCases> equal_cases(const LoadedStudy& study, const std::vector<StudyRun>& runs) {
  const std::vector<StudyCase>& cases = study.config.cases;
  std::vector<EqualCases> groups;
  std::vector<bool> taken(cases.size(), false);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::optional<Outcome> outcome = outcome_of(i, runs);
    if (taken[i] || !outcome) continue;
    EqualCases group{{cases[i].name}, true, true};
    for (std::size_t k = i + 1; k < cases.size(); ++k) {
      const std::optional<Outcome> other = outcome_of(k, runs);
      if (taken[k] || !other || !other->is_like(*outcome)) continue;
      taken[k] = true;
      group.cases.push_back(cases[k].name);
      group.same_settings &= cases[k].sets() == cases[i].sets();
      group.same_state &= other->hashes == outcome->hashes;
    }
    if (group.cases.size() > 1) groups.push_back(std::move(group));
  }
  return groups;
}

std::string equal_cases_text(const EqualCases& group) {
  std::vector<std::string> quoted;
  for (const std::string& name : group.cases) quoted.push_back("'" + name + "'");
  const std::string what =
      group.same_state ? "all runs gave the same result" : "every figure is the same for every seed";
  return "cases " + sim::list_text(quoted) + " do not differ: " + what + ", " +
         (group.same_settings ? "as they have the same settings"
                              : "although their settings differ: check that the settings have an effect");
}

}  // namespace experiment
