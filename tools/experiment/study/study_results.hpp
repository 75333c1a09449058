// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/experiment/score/interval.hpp"
#include "tools/experiment/score/scoring.hpp"
#include "tools/experiment/study/study_runs.hpp"

namespace tools {

/// Over the seeds of a case.  NaN where there is nothing to make it of.
struct Statistics {
  std::int64_t count = 0;  ///< runs that have the figure
  double mean = no_figure;
  double std = no_figure;  ///< of the sample (n - 1); NaN for one run
  double min = no_figure, max = no_figure, median = no_figure;
  /// 95 % confidence: of the mean by Student's t, of the share that passed by Wilson's score.  NaN for one run.
  Interval mean_95{no_figure, no_figure};

  double by_word(const std::string& word) const;  ///< one of statistic_words()
};

Statistics statistics_of(std::vector<double> values);

/// The value below which a share of the values lies, between neighbours by straight lines.  `sorted` is not empty.
double quantile(const std::vector<double>& sorted, double share);

/// What a study came to.
class StudyResults {
 public:
  StudyResults(const LoadedStudy& study, const std::vector<StudyRun>& runs);

  /// Of one figure; `passed`: 1 when the run passed, 0 when it failed, none when it was not judged.
  Statistics of(const std::string& in_case, const std::string& figure) const;
  std::vector<double> values(const std::string& in_case, const std::string& figure) const;
  /// Every figure of a run, sorted.
  const std::vector<std::string>& figures() const { return figures_; }
  /// Those of the table, as the study orders them.
  std::vector<std::string> table_figures() const;
  std::vector<Scoring::Verdict> verdicts() const;
  /// Runs without a result fail it; without rules it is not judged.
  Judgement judgement() const;
  std::size_t failed_runs() const;
  /// That came to their end all the same.
  std::size_t runs_with_failed_programs() const;

  /// The table on a terminal, and the rules.
  std::string to_text() const;
  std::string to_csv() const;
  std::string to_json(int exit_code) const;

 private:
  std::size_t runs_of(const std::string& in_case) const;
  /// A statistic over the runs of a case.
  FigureValue value_of(const sim::RuleExpression::Figure& figure) const;

  const LoadedStudy& study_;
  const std::vector<StudyRun>& runs_;
  std::vector<std::string> figures_;
};

/// The files of a study that are its plots, in order.
std::vector<std::string> study_plots(const StudyConfig& config);

/// Writes study.csv, study.json, plot.gp, the data of the plots and their plots into a folder.  Throws
/// std::runtime_error.
void write_study(const std::string& directory, const LoadedStudy& study, const std::vector<StudyRun>& runs,
                 const StudyResults& results, int exit_code);

}  // namespace tools
