// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/campaign/verified_runs.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <iostream>
#include <set>
#include <stdexcept>
#include <tuple>

#include "experiment/files/csv.hpp"
#include "experiment/process/signals.hpp"
#include "experiment/study/algorithm_table.hpp"
#include "experiment/study/study_algorithms.hpp"
#include "experiment/study/study_tables.hpp"
#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {
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
  return fmt::format("  the table has shoal {}, {}, {}; this is shoal {}, {}, {}\n", row.shoal, row.processor,
                     row.c_library, own.version, own.processor, own.c_library);
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
  // Last bits may differ between builds and machines, which is then said.
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
    // CPU times differ from run to run.
    if (name.ends_with(std::string(".") + time_of_event)) continue;
    ++verified.figures;
    const auto there = value_in(row.figures, name), here = value_in(run.record->metrics, name);
    if (there != here) verified.differences.push_back(name + ": " + shown(there) + " there, " + shown(here) + " here");
  }
  return verified;
}

namespace {

/// Runs with the figures of rows, in their order, on which the bootstrap depends.
std::vector<StudyRun> runs_of(const LoadedStudy& study, const std::vector<StudyRow>& rows) {
  std::vector<StudyRun> runs;
  for (const StudyRow& row : rows) {
    const auto& cases = study.config.cases;
    const auto in_case =
        std::find_if(cases.begin(), cases.end(), [&](const StudyCase& each) { return each.name == row.in_case; });
    if (in_case == cases.end()) continue;
    StudyRun& run = runs.emplace_back();
    run.in_case = static_cast<std::size_t>(in_case - cases.begin());
    run.point = std::min(row.point > 0 ? row.point - 1 : 0, study.points.size() - 1);
    run.seed = row.seed;
    if (row.run_hash.empty()) continue;
    run.record.emplace();
    run.record->metrics = row.figures;
  }
  return runs;
}

struct CsvLine {
  std::size_t line = 0;
  std::vector<std::string> fields;
};

std::vector<CsvLine> csv_lines(const std::string& text, const std::string& name) {
  std::vector<CsvLine> lines;
  for (std::size_t begin = 0, line = 1; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view of_line(text.data() + begin, end - begin);
    if (of_line.ends_with('\r')) of_line.remove_suffix(1);
    auto fields = csv_fields(of_line);
    if (!fields) throw std::runtime_error(fmt::format("{}:{}: a quote is not closed", name, line));
    lines.push_back({line, std::move(*fields)});
    begin = end + 1;
  }
  return lines;
}

}  // namespace

VerifiedTable compare_with_table(const LoadedStudy& study, const std::vector<StudyRow>& rows, const std::string& text,
                                 const std::string& name, const std::vector<std::string>& cases) {
  const std::vector<StudyRun> runs = runs_of(study, rows);
  const std::vector<CsvLine> here = csv_lines(AlgorithmTable(StudyResults(study, runs)).csv(), ""),
                             there = csv_lines(text, name);
  const std::vector<std::string>& columns = here.front().fields;
  if (there.empty() || there.front().fields != columns)
    throw std::runtime_error(name + ":1: the columns must be " + fmt::format("{}", fmt::join(columns, ",")));
  VerifiedTable verified;
  for (std::size_t i = 1; i < there.size(); ++i) {
    const auto& [line, fields] = there[i];
    if (fields.size() != columns.size())
      throw std::runtime_error(
          fmt::format("{}:{}: must have {} fields, got {}", name, line, columns.size(), fields.size()));
    // In a study with factors the name of a world is followed by the values of its point.
    if (!cases.empty() && std::none_of(cases.begin(), cases.end(), [&world = fields[0]](const std::string& each) {
          return world == each || world.starts_with(each + " (");
        }))
      continue;
    ++verified.rows;
    const auto found = std::find_if(here.begin() + 1, here.end(), [&of_table = fields](const CsvLine& each) {
      return each.fields[0] == of_table[0] && each.fields[1] == of_table[1];
    });
    if (found == here.end()) {
      verified.differences.push_back(fmt::format("{}:{}: study.csv has no '{}' in '{}'", name, line,
                                                 sim::shortened(sim::printable(fields[1])),
                                                 sim::shortened(sim::printable(fields[0]))));
      continue;
    }
    for (std::size_t column = 2; column < columns.size(); ++column)
      if (fields[column] != found->fields[column])
        verified.differences.push_back(fmt::format("{}:{}: '{}' is '{}', study.csv gives '{}'", name, line,
                                                   columns[column], sim::shortened(sim::printable(fields[column])),
                                                   found->fields[column]));
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

namespace {

using Fields = std::vector<std::string>;

/// Columns before the figures, and after them.
constexpr const char* first_columns[] = {"case",  "seed",       "exit_code", "passed",
                                         "ended", "sim_time_s", "wall_s",    "run_hash"};
constexpr std::size_t first_figure = std::size(first_columns);

/// Reader of the rows, which knows the columns.
class RowReader {
 public:
  RowReader(Fields head, std::string name) : head_(std::move(head)), name_(std::move(name)) {
    for (std::size_t i = 0; i < first_figure; ++i)
      if (i >= head_.size() || head_[i] != first_columns[i])
        fail(1, fmt::format("column {} must be '{}': this is not a study.csv of shoal", i + 1, first_columns[i]));
    if (std::set<std::string>(head_.begin(), head_.end()).size() != head_.size())
      fail(1, "each column must be named once");
    const auto run = std::find(head_.begin() + first_figure, head_.end(), "run");
    run_ = static_cast<std::size_t>(run - head_.begin());
    if (head_.size() < run_ + 5) fail(1, "the last columns must be run, point, ..., shoal, processor, c_library");
  }

  StudyRow read(std::size_t line, const Fields& fields) const {
    if (fields.size() != head_.size())
      fail(line, fmt::format("must have {} fields, got {}", head_.size(), fields.size()));
    StudyRow row;
    row.in_case = fields[0];
    row.seed = whole(line, fields, 1);
    row.exit_code = fields[2];
    row.passed = fields[3];
    row.ended = fields[4];
    row.sim_time_s = fields[5];
    row.run_hash = fields[first_figure - 1];
    for (std::size_t i = first_figure; i < run_; ++i) {
      std::optional<double>& value = row.figures[head_[i]];
      if (fields[i].empty()) continue;
      value = sim::exact_number<double>(fields[i]);
      if (!value) wrong(line, fields, i, "a number");
    }
    row.point = static_cast<std::size_t>(whole(line, fields, run_ + 1));
    const std::size_t end = fields.size();
    row.shoal = fields[end - 3];
    row.processor = fields[end - 2];
    row.c_library = fields[end - 1];
    return row;
  }

  [[noreturn]] void fail(std::size_t line, const std::string& rule) const {
    throw std::runtime_error(fmt::format("{}:{}: {}", name_, line, rule));
  }

 private:
  std::int64_t whole(std::size_t line, const Fields& fields, std::size_t column) const {
    const auto value = sim::exact_number<std::int64_t>(fields[column]);
    if (!value || *value < 0) wrong(line, fields, column, "a whole number from 0 on");
    return *value;
  }
  [[noreturn]] void wrong(std::size_t line, const Fields& fields, std::size_t column, const char* rule) const {
    fail(line, fmt::format("'{}' must be {}, got '{}'", sim::shortened(sim::printable(head_[column])), rule,
                           sim::shortened(sim::printable(fields[column]))));
  }

  Fields head_;
  std::string name_;
  std::size_t run_ = 0;  ///< column of the number of the run
};

}  // namespace

std::vector<StudyRow> parse_study_rows(const std::string& text, const std::string& name) {
  std::vector<StudyRow> rows;
  std::set<std::tuple<std::string, std::size_t, std::int64_t>> runs;
  std::optional<RowReader> reader;
  std::size_t line = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view of_line(text.data() + begin, end - begin);
    // Spreadsheets end lines with CR LF.
    if (of_line.ends_with('\r')) of_line.remove_suffix(1);
    begin = end + 1;
    ++line;
    auto fields = csv_fields(of_line);
    if (!fields) throw std::runtime_error(fmt::format("{}:{}: a quote is not closed", name, line));
    if (!reader)
      reader.emplace(std::move(*fields), name);
    else
      rows.push_back(reader->read(line, *fields));
    if (rows.empty()) continue;
    const StudyRow& row = rows.back();
    if (!runs.insert({row.in_case, row.point, row.seed}).second)
      throw std::runtime_error(fmt::format("{}:{}: a second row of case '{}', seed {}", name, line,
                                           sim::shortened(sim::printable(row.in_case)), row.seed));
  }
  if (!reader) throw std::runtime_error(name + ": is empty");
  return rows;
}

}  // namespace experiment
