// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "experiment/study/study_runs.hpp"

namespace experiment {

struct TuneOptions {
  StudyOptions study;
  std::string figure;              ///< of the runs
  std::string statistic = "mean";  ///< of the figure over the cases and seeds of a point: one of statistic_words()
  bool maximize = false;           ///< the largest value is best; otherwise the smallest
  int generations = 20;
  int population = 0;     ///< points of a generation; 0: 4 + 3 ln n
  double sigma = 0.3;     ///< initial standard deviation, as a fraction of each range
  std::int64_t seed = 1;  ///< of the search
};

/// Point that was tried.
struct TunedPoint {
  int generation = 0;     ///< from 1
  std::size_t point = 0;  ///< index into the points of the study
  double value = 0;       ///< statistic of the figure; NaN: a run failed or lacks the figure
  std::size_t runs = 0;
  std::size_t failed = 0;  ///< runs in which a rule of the world does not hold
  Judgement judgement = Judgement::not_judged;
};

/// Search for the values of the factors of a study that make a figure best, by CMA-ES.  A point where fewer runs break
/// the rules of their world is better, whatever the figure; those with equally many are compared by the figure.
class Tuning {
 public:
  /// Throws sim::ConfigError when the study has no factors, or one that is not a range.
  Tuning(LoadedStudy study, TuneOptions options);

  /// Executes all generations.  `after`: called after each.  Finished runs of an earlier call are used again.  Ends
  /// early after a signal.  Throws std::runtime_error, also when no point of the first generation has a value.
  void run(const std::function<void(int generation)>& after);

  const std::vector<TunedPoint>& tried() const { return tried_; }
  /// Returns the best point; null: no point has a value.
  const TunedPoint* best() const;
  const LoadedStudy& study() const { return study_; }
  /// Returns a row for each point.
  std::string to_csv() const;
  /// Returns the command that runs the world with the values of a point.
  std::string command(const TunedPoint& point) const;

 private:
  bool better(const TunedPoint& a, const TunedPoint& b) const;
  TunedPoint point_of(int generation, std::size_t point, const std::vector<StudyRun>& runs) const;

  LoadedStudy study_;
  TuneOptions options_;
  std::vector<TunedPoint> tried_;
};

/// Returns values for a search that maximizes: all finite, those of points where more runs break the rules
/// of their world below those with fewer, and those of points without a value below all others.
std::vector<double> ranked_values(const std::vector<TunedPoint>& points, bool maximize);

}  // namespace experiment
