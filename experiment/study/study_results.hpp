// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiment/score/interval.hpp"
#include "experiment/score/paired.hpp"
#include "experiment/score/scoring.hpp"
#include "experiment/study/study_runs.hpp"

namespace experiment {

class AlgorithmTable;

/// Statistics over the seeds of a case.  NaN where there is no data.
struct Statistics {
  std::int64_t count = 0;  ///< runs that have the figure
  double mean = no_figure;
  double std = no_figure;  ///< of the sample (n - 1); NaN for one run
  double min = no_figure, max = no_figure, median = no_figure;
  /// 95 % confidence intervals: of the mean by Student's t, of the proportion that passed by Wilson's score.  NaN for
  /// one run.
  Interval mean_95{no_figure, no_figure};
  Interval median_95{no_figure, no_figure};  ///< by order statistics, see median_interval_95()

  double by_word(const std::string& word) const;  ///< one of statistic_words()
};

Statistics statistics_of(std::vector<double> values);
/// Does the same, with the interval of a proportion for `passed`.
Statistics statistics_of_figure(const std::string& figure, const std::vector<double>& values);

/// Returns a figure of a run; `passed`: 1 when the run passed, 0 when it failed.  NaN: the run has no result, was not
/// judged or has no such figure.
double figure_of(const StudyRun& run, const std::string& figure);

/// Returns the quantile of `share`, with linear interpolation.  `sorted` is not empty.
double quantile(const std::vector<double>& sorted, double share);

/// Differences of a figure in pairs of runs with equal seeds: between two cases at equal points, or between two points
/// of the only case.
struct StudyComparison {
  std::string compared, base;  ///< names of cases, or values of points such as `loss = 0.5, g = 1.62`
  std::string figure;
  PairedComparison difference;  ///< compared minus base
};

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
  /// Returns the statistics of one figure over the seeds of a case at a point.
  Statistics at_point(std::size_t in_case, std::size_t point, const std::string& figure) const;
  /// Compares each case with the first one, or each of a few points with the first one, by the figures of the table.
  std::vector<StudyComparison> comparisons() const;
  /// Sentence about runs of different programs, processor classes or C libraries; empty when there is only one kind.
  std::string mixture() const;
  const std::vector<StudyRun>& runs() const { return runs_; }
  const LoadedStudy& study() const { return study_; }
  /// Returns the table of the algorithms, which is computed at the first call.
  const AlgorithmTable& algorithm_table() const;
  /// Number of runs with failed programs that nevertheless reached their end.
  std::size_t runs_with_failed_programs() const;

  /// Returns the table for a terminal, and the rules.
  /// `directory`: of the study, for the commands that repeat failed runs.
  std::string to_text(const std::string& directory = "") const;
  /// Returns a row for each run.  Equal runs give equal rows, except for `wall_s` and CPU times.
  std::string to_csv() const;
  /// Returns a row of statistics for each case, point and figure.
  std::string points_csv() const;
  std::string points_text() const;
  std::string to_json(int exit_code) const;

 private:
  std::size_t runs_of(const std::string& in_case) const;
  /// Returns a statistic over the runs of a case.
  FigureValue value_of(const sim::RuleExpression::Figure& figure) const;

  const LoadedStudy& study_;
  const std::vector<StudyRun>& runs_;
  std::vector<std::string> figures_;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<const StudyRun*>> groups_;  ///< by case and point
  mutable std::shared_ptr<const AlgorithmTable> algorithm_table_;
};

/// Returns the plot files of a study, in order.
std::vector<std::string> study_plots(const StudyConfig& config);

/// Throws std::runtime_error when a file of the results of a study cannot be written in its folder, or is a symbolic
/// link; for errors before a long work.  Writes nothing.
void check_outputs(const std::string& directory, const StudyConfig& config);

/// Writes study.csv, points.csv, study.json, plot.gp, the data of the plots and their plots into a folder, and with
/// algorithms algorithms.csv and algorithms.md, after check_outputs().  Throws std::runtime_error.
void write_study(const std::string& directory, const LoadedStudy& study, const std::vector<StudyRun>& runs,
                 const StudyResults& results, int exit_code);

/// Cases of a study with equal results.
struct EqualCases {
  std::vector<std::string> cases;  ///< two or more, as the study orders them
  bool same_settings = false;      ///< they change the same settings; otherwise a setting has no effect
  bool same_state = false;         ///< the final states are equal, too
};

/// Groups of cases whose runs have the same figures for every seed or, where a world has no figures, the same final
/// state.  A case with a run without a result is in no group.
std::vector<EqualCases> equal_cases(const LoadedStudy& study, const std::vector<StudyRun>& runs);

/// Returns a readable sentence about a group.
std::string equal_cases_text(const EqualCases& group);

}  // namespace experiment
