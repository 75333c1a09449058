// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "experiment/score/interval.hpp"

namespace experiment {

/// Comparison of two variants over pairs of runs with equal seeds.  NaN where there are too few pairs.
struct PairedComparison {
  std::size_t pairs = 0;
  double mean = 0, median = 0;                   ///< of the differences
  Interval mean_95;                              ///< by Student's t over the differences; needs two pairs
  std::size_t higher = 0, lower = 0, equal = 0;  ///< pairs with a positive, negative and no difference
  double sign_p = 1;                             ///< two-sided probability by the sign test
  double wilcoxon_p = 1;                         ///< two-sided probability by the signed-rank test of Wilcoxon
};

/// Compares by the differences of the pairs, which are finite.
PairedComparison compare_pairs(std::vector<double> differences);

/// Two-sided probability of the sign test: that of at most min(higher, lower) of n = higher + lower tosses of a fair
/// coin, doubled (Conover, Practical Nonparametric Statistics, section 3.4).  1 for n = 0.
double sign_test(std::size_t higher, std::size_t lower);

/// Two-sided probability of Wilcoxon's signed-rank test (Wilcoxon 1945).  Differences of 0 are left out, equal sizes
/// have their mean rank.  For up to 50 differences it is exact, even with ties: the share of all choices of signs,
/// given the ranks, whose smaller sum of ranks is not greater (Hollander, Wolfe and Chicken, section 3.1).  Otherwise
/// by the normal distribution with corrections for ties and for continuity.  1 without differences.
double wilcoxon_test(const std::vector<double>& differences);

}  // namespace experiment
