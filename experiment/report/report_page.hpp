// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiment/files/json_reader.hpp"
#include "experiment/results/run_metrics.hpp"
#include "experiment/results/run_record.hpp"
#include "experiment/score/rule_verdict.hpp"

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

/// Returns the plots of a directory as HTML, each with its caption (by file name; default: the name); lists the plots
/// that are missing or not a complete PNG file.
std::string plots_html(const std::string& directory, const std::vector<std::string>& files,
                       const std::map<std::string, std::string>& captions);

/// Returns the plots of a run.
std::string run_plots_html(const RunRecord& run);

/// Returns whether the bytes are a PNG file from its signature to its last chunk, in which each checksum is valid.
bool is_whole_png(std::string_view bytes);

/// Describes the outcome of rules in one line: `7 of 8 rules hold, 1 failed.`  Empty when there are none.
std::string rules_in_words(const std::vector<RunRecord::Rule>& rules);

/// Describes the results of the metrics, one sentence each:
/// `auv localizes itself to 0.91 m rms (cooperative); alone: 61 m rms, 138 m at the end, after 2.81 km.`
std::vector<std::string> findings_in_words(const std::vector<RunMetric>& metrics);
/// Describes the contacts between bodies: `auv4 hits rock at 105.7 s, 3 times in all.`
std::vector<std::string> contacts_in_words(const RunRecord& run);

/// Returns a length in a readable unit: `0.91 m`, `138 m`, `2.81 km`.
std::string length_text(double length_m);

/// Returns the page of a study's folder, from its study.json.  Throws std::runtime_error with file and reason.
std::string study_report(const std::string& directory);

/// Returns the part of a study's page about its algorithms of cooperative navigation: which one is best in each world,
/// a chart of the rms over the bound, a table of algorithms and worlds, and differences in pairs.  Empty for a study
/// without algorithms.  Throws std::runtime_error with the key and the rule.
std::string study_algorithms_html(const JsonReader& in);

/// Parts of the page of a study, from its study.json.  Each is empty when an older file lacks the data.  They throw
/// std::runtime_error with the key and the rule.

/// Returns curves of the figures over each factor, and of means over the number of seeds, as SVG.  `units`: of figures.
std::string study_charts_html(const JsonReader& in, const std::map<std::string, std::string>& units);
/// Returns the table of differences in pairs of equal seeds.
std::string study_comparisons_html(const JsonReader& in);
/// Returns the runs with the largest and smallest figures, with links to their pages and films in the folder of the
/// study.
std::string study_extremes_html(const JsonReader& in, const std::string& directory);

}  // namespace experiment
