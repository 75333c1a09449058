// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiment/study/study_runs.hpp"

namespace experiment {

/// Row of study.csv: the result of a run, perhaps of someone else.
struct StudyRow {
  std::string in_case;
  std::int64_t seed = 0;
  std::size_t point = 0;                             ///< from 1; 0: the study has no factors
  std::string run_hash;                              ///< empty: the run has no result
  std::string exit_code, passed, ended, sim_time_s;  ///< as text of the table
  std::map<std::string, std::optional<double>> figures;
  std::string shoal, processor, c_library;
};

/// Parses the text of a study.csv, with all its columns.  `name`: of the file, for errors.  Throws std::runtime_error
/// with line, column and rule.
std::vector<StudyRow> parse_study_rows(const std::string& text, const std::string& name);

/// Comparison of a run with a row of a study.csv.
struct Verified {
  std::size_t figures = 0;               ///< that were compared
  std::vector<std::string> differences;  ///< `run hash: 1f there, 2e here`; empty: the run is equal, bit for bit
};
/// Compares all figures of the row and of the run but the CPU times of algorithms.
Verified compare_with_row(const StudyRun& run, const StudyRow& row);

/// Executes runs of a study again, in the folder of `options`, and compares each with its row: prints a line for each
/// and a summary.  Returns the number of those that differ, fail or have no row.  A signal ends it early.  Throws
/// std::runtime_error.
std::size_t verify_runs(const LoadedStudy& study, const StudyOptions& options, std::vector<StudyRun>& runs,
                        const std::vector<std::size_t>& which, const std::vector<StudyRow>& rows);

/// Differences of an algorithms.csv from the table that the rows of its study.csv give, for some cases or, when
/// `cases` is empty, all of them.
struct VerifiedTable {
  std::size_t rows = 0;                  ///< that were compared
  std::vector<std::string> differences;  ///< `algorithms.csv:7: 'rms_m' is 2.1, study.csv gives 2.2`
};
/// `text`, `name`: content and name of the algorithms.csv.  Throws std::runtime_error with line and rule when it is not
/// a table of this version.
VerifiedTable compare_with_table(const LoadedStudy& study, const std::vector<StudyRow>& rows, const std::string& text,
                                 const std::string& name, const std::vector<std::string>& cases);

}  // namespace experiment
