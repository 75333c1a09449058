// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/experiment/results/run_metrics.hpp"

namespace tools {

/// The figures of one run by metric, each with its unit and meaning.  Counts that are 0 are folded away, except for a
/// metric's most important figure and for figures that a rule names.
std::string figures_html(const std::vector<RunMetric>& metrics, const std::vector<RunRecord::Rule>& rules);

/// The figures of several runs, or statistics of several cases, side by side and by metric.
class FigureColumns {
 public:
  struct Row {
    std::string figure;               ///< `cooperative.rms_m`
    std::string label;                ///< of the row, such as a case; empty: the name of the figure
    std::vector<std::string> values;  ///< a text for each column
    bool idle = false;                ///< 0 everywhere: folded away
  };

  /// `head`: of the columns after the first.  `figures`: all that there are, which tell the types of the metrics.
  FigureColumns(std::vector<std::string> head, const std::vector<std::string>& figures)
      : head_(std::move(head)), metrics_(metrics_named(figures)) {}
  /// Of one of `figures`.
  void add(Row row) { rows_.push_back(std::move(row)); }
  std::string html() const;

 private:
  std::string table(const RunMetric& metric, bool idle) const;
  std::string rows_of(const std::string& full_name, const RunMetric::Figure& figure, bool idle) const;

  std::vector<std::string> head_;
  std::vector<RunMetric> metrics_;
  std::vector<Row> rows_;
};

}  // namespace tools
