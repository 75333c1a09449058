// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "experiment/results/run_metrics.hpp"

namespace experiment {

/// Returns the figures of one run by metric, each with its unit and meaning.  Counts of 0 are collapsed, except for a
/// metric's most important figure and for figures that a rule names.
std::string figures_html(const std::vector<RunMetric>& metrics, const std::vector<RunRecord::Rule>& rules);

/// Figures of several runs, or statistics of several cases, side by side and by metric.
class FigureColumns {
 public:
  struct Row {
    std::string figure;               ///< `cooperative.rms_m`
    std::string label;                ///< label of the row, such as a case; empty: the name of the figure
    std::vector<std::string> values;  ///< one text per column
    bool idle = false;                ///< 0 in all columns: collapsed
  };

  /// `head`: of the columns after the first.  `figures`: all figures, which determine the types of the metrics.
  FigureColumns(std::vector<std::string> head, const std::vector<std::string>& figures)
      : head_(std::move(head)), metrics_(metrics_named(figures)) {}
  /// Adds a row of one of `figures`.
  void add(Row row) { rows_.push_back(std::move(row)); }
  std::string html() const;

 private:
  std::string table(const RunMetric& metric, bool idle) const;
  std::string rows_of(const std::string& full_name, const RunMetric::Figure& figure, bool idle) const;

  std::vector<std::string> head_;
  std::vector<RunMetric> metrics_;
  std::vector<Row> rows_;
};

}  // namespace experiment
