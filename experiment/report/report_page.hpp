// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiment/results/run_metrics.hpp"
#include "experiment/results/run_record.hpp"
#include "experiment/score/judgement.hpp"

namespace experiment {

/// Returns a results directory as one HTML page that needs no network: verdict and plots first, then figures by metric,
/// logs of programs and facts about the run.  Also accepts the directory of a study; several directories of runs are
/// compared. Throws std::runtime_error with file and reason.  `page_in_3d`: address of the page of a single run that
/// shows it in three dimensions, relative to this one; empty: there is none.
std::string report_page(const std::vector<std::string>& directories, const std::string& page_in_3d = "");

/// Returns the page of one run.
std::string run_report(const RunRecord& run, const std::string& page_in_3d = "");
/// Returns a page that compares runs side by side.
std::string comparison_report(const std::vector<RunRecord>& runs);

/// Returns verdict, rules, and the findings in words.
std::string outcome_html(const RunRecord& run, const std::vector<RunMetric>& metrics);
/// Returns `passed`, `FAILED` or `not judged`, colored; `why` follows after a colon.
std::string judgement_html(Judgement judgement, const std::string& why = "");
std::string verdict_html(bool passed);
/// Returns the rules with their outcome: failed ones first, then the passed ones, collapsed.
std::string rules_html(const std::vector<RunRecord::Rule>& rules);
/// Returns a box with a colored edge and the content `html`.
std::string verdict_box(Judgement judgement, const std::string& html);
/// Returns texts as a list; empty if there are none.
std::string list_html(const std::vector<std::string>& texts);
/// Returns a table of names and values.
std::string facts_table(const std::vector<std::pair<std::string, std::string>>& facts);
/// Returns the version of the program that wrote the page.
std::string made_by_html();

}  // namespace experiment
