// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/experiment/score/interval.hpp"
#include "tools/experiment/score/scoring.hpp"
#include "tools/experiment/study/study_runs.hpp"

namespace tools {

/// Statistics over the seeds of a case.  NaN where there is no data.
struct Statistics {
  std::int64_t count = 0;  ///< runs that have the figure
  double mean = no_figure;
  double std = no_figure;  ///< of the sample (n - 1); NaN for one run
  double min = no_figure, max = no_figure, median = no_figure;
  /// 95 % confidence intervals: of the mean by Student's t, of the proportion that passed by Wilson's score.  NaN for
  /// one run.
  Interval mean_95{no_figure, no_figure};

  double by_word(const std::string& word) const;  ///< one of statistic_words()
};

Statistics statistics_of(std::vector<double> values);

/// Returns the quantile of `share`, with linear interpolation.  `sorted` is not empty.
double quantile(const std::vector<double>& sorted, double share);

/// Results of a study.
class StudyResults {
 public:
  StudyResults(const LoadedStudy& study, const std::vector<StudyRun>& runs);

  /// Returns the statistics of one figure; `passed`: 1 when the run passed, 0 when it failed, none when it was not
  /// judged.
  Statistics of(const std::string& in_case, const std::string& figure) const;
  std::vector<double> values(const std::string& in_case, const std::string& figure) const;
  /// Figures of all runs, sorted.
  const std::vector<std::string>& figures() const { return figures_; }
  /// Figures of the table, in the order of the study.
  std::vector<std::string> table_figures() const;
  std::vector<Scoring::Verdict> verdicts() const;
  /// Judges the study: runs without a result fail it; without rules it is not judged.
  Judgement judgement() const;
  std::size_t failed_runs() const;
  /// Number of runs with failed programs that nevertheless reached their end.
  std::size_t runs_with_failed_programs() const;

  /// Returns the table for a terminal, and the rules.
  std::string to_text() const;
  std::string to_csv() const;
  std::string to_json(int exit_code) const;

 private:
  std::size_t runs_of(const std::string& in_case) const;
  /// Returns a statistic over the runs of a case.
  FigureValue value_of(const sim::RuleExpression::Figure& figure) const;

  const LoadedStudy& study_;
  const std::vector<StudyRun>& runs_;
  std::vector<std::string> figures_;
};

/// Returns the plot files of a study, in order.
std::vector<std::string> study_plots(const StudyConfig& config);

/// Writes study.csv, study.json, plot.gp, the data of the plots and their plots into a folder.  Throws
/// std::runtime_error.
void write_study(const std::string& directory, const LoadedStudy& study, const std::vector<StudyRun>& runs,
                 const StudyResults& results, int exit_code);

}  // namespace tools
