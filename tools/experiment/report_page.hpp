#pragma once

#include <string>
#include <vector>

#include "tools/experiment/run_record.hpp"

namespace tools {

/// A results directory as one HTML page that needs no network: verdicts first, then figures, pictures, programs and
/// warnings.  Takes a study's directory too; several directories of runs become a table that compares them.
/// Throws std::runtime_error with file and reason.
std::string report_page(const std::vector<std::string>& directories);

/// The page of one run.
std::string run_report(const RunRecord& run);
/// Runs beside each other.
std::string comparison_report(const std::vector<RunRecord>& runs);

/// A figure of the page as a number of a few digits, `-` when there is none.
std::string figure_text(const std::optional<double>& value);
/// Pictures of a directory as HTML; those that are missing or no PNG are named.
std::string pictures_html(const std::string& directory, const std::vector<std::string>& files);
/// `passed`, `FAILED` or `not judged`, coloured.
std::string verdict_html(Judgement judgement);
/// Rules with their outcome, failed ones first.
std::string rules_html(std::vector<RunRecord::Rule> rules);

}  // namespace tools
