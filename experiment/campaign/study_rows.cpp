// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/campaign/study_rows.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <tuple>

#include "experiment/files/csv.hpp"
#include "sim/base/number.hpp"
#include "sim/config/message_text.hpp"

namespace experiment {

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
