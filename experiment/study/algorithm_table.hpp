// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiment/study/study_results.hpp"

namespace experiment {

/// Whether the covariance of an algorithm is consistent, by the 95 % interval of the mean NEES over the seeds.
enum class Trust {
  unknown,        ///< fewer than five runs
  consistent,     ///< the interval has 2 in it
  unclear,        ///< so it has, but it reaches beyond 4: a few runs decide
  overconfident,  ///< it lies above 2: the errors are larger than the algorithm says
  conservative,   ///< it lies below 2
};
const char* trust_word(Trust trust);

/// An algorithm in a world, over the seeds.  Values are NaN without data.
struct AlgorithmCell {
  std::string world, algorithm;
  std::size_t runs = 0;      ///< with estimates of all scored vehicles
  std::size_t planned = 0;   ///< of the study
  double rms_m = no_figure;  ///< root of the mean square over the seeds
  Interval rms_95{no_figure, no_figure};
  double nees = no_figure;  ///< mean; its interval by Student's t
  Interval nees_95{no_figure, no_figure};
  double inside_95 = no_figure;
  double efficiency = no_figure;  ///< sqrt(sum of the bound's squares / sum of the squared errors); 1 is the reference
  Interval efficiency_95{no_figure, no_figure};
  double bytes_per_h = no_figure;   ///< of a vehicle
  double us_per_event = no_figure;  ///< median
  Trust trust = Trust::unknown;
};

/// The rms of an algorithm over that of another, in pairs of equal seeds.
struct AlgorithmPair {
  std::string world, algorithm, base;
  std::size_t pairs = 0;
  double factor = no_figure;                 ///< geometric mean
  Interval factor_95{no_figure, no_figure};  ///< by Student's t over the logarithms
  double wilcoxon_p = 1;
};

/// Table of a study with algorithms.
///
/// Intervals of the rms and the efficiency are bootstrap percentiles over the seeds (Efron 1979), of 2000 samples drawn
/// by a fixed seed, so that the same results give the same table.  With factors each point of the design counts as
/// a world.
class AlgorithmTable {
 public:
  explicit AlgorithmTable(const StudyResults& results);

  const std::vector<AlgorithmCell>& cells() const { return cells_; }  ///< by world, then by algorithm
  const std::vector<AlgorithmPair>& pairs() const { return pairs_; }  ///< of all but the base of the study
  /// Returns one sentence for each world: which algorithm has the smallest rms, its margin, and whether its covariance
  /// is consistent.
  std::vector<std::string> sentences() const;

  std::string text() const;
  /// Returns the table of a page of Markdown.
  std::string markdown() const;
  std::string csv() const;
  nlohmann::ordered_json json() const;

 private:
  std::vector<AlgorithmCell> cells_;
  std::vector<AlgorithmPair> pairs_;
  std::string base_;
  std::vector<AlgorithmPair> winners_;  ///< of each world, the second best over the best
};

}  // namespace experiment
