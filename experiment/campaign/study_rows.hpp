// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

/// Splits a line of a CSV file into fields, of which some are in quotes.  std::nullopt if a quote is not closed.
std::optional<std::vector<std::string>> csv_fields(std::string_view line);

/// Parses the text of a study.csv, with all its columns.  `name`: of the file, for errors.  Throws std::runtime_error
/// with line, column and rule.
std::vector<StudyRow> parse_study_rows(const std::string& text, const std::string& name);

}  // namespace experiment
