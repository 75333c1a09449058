// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/campaign/verified_runs.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <iostream>
#include <set>

#include "tools/experiment/process/signals.hpp"
#include "tools/experiment/study/study_algorithms.hpp"
#include "tools/experiment/study/study_tables.hpp"

namespace tools {

namespace {

constexpr std::size_t max_shown = 5;

std::string shown(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : "none";
}

const StudyRow* row_of(const LoadedStudy& study, const StudyRun& run, const std::vector<StudyRow>& rows) {
  const std::size_t point = study.config.factors.empty() ? 0 : run.point + 1;
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const StudyRow& row) {
    return row.in_case == study.config.cases[run.in_case].name && row.seed == run.seed && row.point == point;
  });
  return found == rows.end() ? nullptr : &*found;
}

/// Returns what the row was computed by, when that is not what computed the run.
std::string other_kind(const StudyRun& run, const StudyRow& row) {
  const RunKind own = kind_of(*run.record);
  if (row.shoal == own.version && row.processor == own.processor && row.c_library == own.c_library) return {};
  return fmt::format("  that of the table is of shoal {}, {}, {}; this one of shoal {}, {}, {}\n", row.shoal,
                     row.processor, row.c_library, own.version, own.processor, own.c_library);
}

std::string outcome_of(const StudyRun& run, const StudyRow* row, bool& equal) {
  equal = false;
  if (row == nullptr) return "the table has no such run\n";
  if (!run.record) return "no result: " + run.failure + "\n";
  if (row->run_hash.empty()) return "has no result in the table\n";
  const Verified verified = compare_with_row(run, *row);
  equal = verified.differences.empty();
  if (equal) return fmt::format("equal: run hash {}, {} figures\n", row->run_hash, verified.figures);
  std::string text = fmt::format("DIFFERS in {} of {} values\n", verified.differences.size(), verified.figures + 5);
  for (std::size_t i = 0; i < std::min(max_shown, verified.differences.size()); ++i)
    text += "  " + verified.differences[i] + "\n";
  if (verified.differences.size() > max_shown) text += "  ...\n";
  return text + other_kind(run, *row);
}

}  // namespace

Verified compare_with_row(const StudyRun& run, const StudyRow& row) {
  Verified verified;
  const RunRecord& record = *run.record;
  const auto passed = as_flag(record.judgement);
  const auto compare = [&](const char* what, const std::string& there, const std::string& here) {
    if (there != here) verified.differences.push_back(std::string(what) + ": " + there + " there, " + here + " here");
  };
  compare("run hash", row.run_hash, record.run_hash);
  compare("exit_code", row.exit_code, fmt::format("{}", record.exit_code));
  compare("passed", row.passed, !passed ? "" : *passed ? "1" : "0");
  compare("ended", row.ended, record.ended);
  compare("sim_time_s", row.sim_time_s, fmt::format("{}", record.sim_time_s));
  std::set<std::string> names;
  for (const auto& [name, value] : row.figures) names.insert(name);
  for (const auto& [name, value] : run.record->metrics) names.insert(name);
  const auto value_in = [](const auto& figures, const std::string& name) {
    const auto found = figures.find(name);
    return found == figures.end() ? std::optional<double>() : found->second;
  };
  for (const std::string& name : names) {
    if (name.ends_with(std::string(".") + time_of_event)) continue;
    ++verified.figures;
    const auto there = value_in(row.figures, name), here = value_in(run.record->metrics, name);
    if (there != here) verified.differences.push_back(name + ": " + shown(there) + " there, " + shown(here) + " here");
  }
  return verified;
}

std::size_t verify_runs(const LoadedStudy& study, const StudyOptions& options, std::vector<StudyRun>& runs,
                        const std::vector<std::size_t>& which, const std::vector<StudyRow>& rows) {
  // A run without a row is found before the work.
  std::vector<std::size_t> known;
  for (const std::size_t i : which)
    if (row_of(study, runs[i], rows) != nullptr) known.push_back(i);
  StudyProgress progress{known.size()};
  run_study(study, options, runs, known, progress);
  std::size_t equal_runs = 0;
  for (const std::size_t i : which) {
    if (caught_signal() != 0) return which.size() - equal_runs;
    bool equal = false;
    const std::string of_point =
        study.config.factors.empty() ? "" : ", " + values_text(study.config, study.points[runs[i].point]);
    const std::string outcome = outcome_of(runs[i], row_of(study, runs[i], rows), equal);
    std::cout << fmt::format("{}{}, seed {}: {}", study.config.cases[runs[i].in_case].name, of_point, runs[i].seed,
                             outcome);
    equal_runs += equal ? 1 : 0;
  }
  std::cout << fmt::format("{} of {} runs are equal\n", equal_runs, which.size());
  return which.size() - equal_runs;
}

}  // namespace tools
