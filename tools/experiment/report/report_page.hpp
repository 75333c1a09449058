// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/experiment/results/run_metrics.hpp"
#include "tools/experiment/results/run_record.hpp"
#include "tools/experiment/score/judgement.hpp"

namespace tools {

/// A results directory as one HTML page that needs no network: verdict and plots first, then figures by metric, logs of
/// programs and facts about the run.  Takes a study's directory too; several directories of runs are compared.
/// Throws std::runtime_error with file and reason.
std::string report_page(const std::vector<std::string>& directories);

/// The page of one run.
std::string run_report(const RunRecord& run);
/// Compares runs side by side.
std::string comparison_report(const std::vector<RunRecord>& runs);

/// Verdict, rules, and what came out in words.
std::string outcome_html(const RunRecord& run, const std::vector<RunMetric>& metrics);
/// `passed`, `FAILED` or `not judged`, coloured; `why` follows it after a colon.
std::string judgement_html(Judgement judgement, const std::string& why = "");
std::string verdict_html(bool passed);
/// Rules with their outcome: those that failed, then those that hold folded away.
std::string rules_html(const std::vector<RunRecord::Rule>& rules);
/// A box with a coloured edge and the content `html`.
std::string verdict_box(Judgement judgement, const std::string& html);
/// Texts as a list; empty: nothing.
std::string list_html(const std::vector<std::string>& texts);
/// A table of names and values.
std::string facts_table(const std::vector<std::pair<std::string, std::string>>& facts);
/// The version that made the page.
std::string made_by_html();

}  // namespace tools
