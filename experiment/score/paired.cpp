// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/paired.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace experiment {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t max_exact = 50;

/// Ranks of the sizes of differences that are not 0.
struct SignedRanks {
  std::vector<std::size_t> doubled;  ///< twice each rank: equal sizes have their mean rank, in halves
  std::size_t positive = 0;          ///< sum of those of positive differences
  double tie_term = 0;               ///< sum of t^3 - t over groups of t equal sizes
};

SignedRanks signed_ranks(std::vector<double> differences) {
  std::erase(differences, 0.0);
  std::sort(differences.begin(), differences.end(), [](double a, double b) { return std::fabs(a) < std::fabs(b); });
  SignedRanks ranks;
  for (std::size_t first = 0; first < differences.size();) {
    std::size_t end = first;
    while (end < differences.size() && std::fabs(differences[end]) == std::fabs(differences[first])) ++end;
    // Ranks first + 1 to end have the mean (first + 1 + end) / 2.
    const std::size_t doubled = first + 1 + end;
    for (std::size_t i = first; i < end; ++i) {
      ranks.doubled.push_back(doubled);
      if (differences[i] > 0) ranks.positive += doubled;
    }
    const auto tied = static_cast<double>(end - first);
    ranks.tie_term += tied * tied * tied - tied;
    first = end;
  }
  return ranks;
}

/// Probability that a random subset of the ranks has a sum of at most `sum`, by the sums of all subsets.
double share_of_subsets(const std::vector<std::size_t>& ranks, std::size_t sum) {
  std::vector<double> shares(std::accumulate(ranks.begin(), ranks.end(), std::size_t{1}), 0.0);
  shares[0] = 1;
  for (const std::size_t rank : ranks)
    for (std::size_t s = shares.size(); s-- > 0;) shares[s] = 0.5 * (shares[s] + (s >= rank ? shares[s - rank] : 0));
  return std::accumulate(shares.begin(), shares.begin() + static_cast<std::ptrdiff_t>(sum + 1), 0.0);
}

}  // namespace

double sign_test(std::size_t higher, std::size_t lower) {
  const std::size_t n = higher + lower;
  return n == 0 ? 1 : std::min(1.0, 2 * fair_coin_share(n, std::min(higher, lower)));
}

double wilcoxon_test(const std::vector<double>& differences) {
  const SignedRanks ranks = signed_ranks(differences);
  const std::size_t count = ranks.doubled.size();
  if (count == 0) return 1;
  const std::size_t all_doubled = count * (count + 1);
  const std::size_t smaller_doubled = std::min(ranks.positive, all_doubled - ranks.positive);
  // Exact for few pairs; else the normal approximation with corrections for ties and continuity (Hollander, Wolfe and
  // Chicken 2014, 3.1).
  if (count <= max_exact) return std::min(1.0, 2 * share_of_subsets(ranks.doubled, smaller_doubled));
  const auto n = static_cast<double>(count);
  const double all = static_cast<double>(all_doubled) / 2, smaller = static_cast<double>(smaller_doubled) / 2;
  const double variance = n * (n + 1) * (2 * n + 1) / 24 - ranks.tie_term / 48;
  const double z = std::max(0.0, all / 2 - smaller - 0.5) / std::sqrt(variance);
  return std::min(1.0, std::erfc(z / std::sqrt(2.0)));
}

PairedComparison compare_pairs(std::vector<double> differences) {
  PairedComparison comparison;
  comparison.pairs = differences.size();
  comparison.mean = comparison.median = nothing;
  comparison.mean_95 = {nothing, nothing};
  if (differences.empty()) return comparison;
  // Signs and tests.
  for (const double difference : differences) {
    if (difference > 0) ++comparison.higher;
    if (difference < 0) ++comparison.lower;
    if (difference == 0) ++comparison.equal;
  }
  comparison.sign_p = sign_test(comparison.higher, comparison.lower);
  comparison.wilcoxon_p = wilcoxon_test(differences);
  // Mean and median.
  const std::size_t n = differences.size();
  comparison.mean = std::accumulate(differences.begin(), differences.end(), 0.0) / static_cast<double>(n);
  double squares = 0;
  for (const double difference : differences)
    squares += (difference - comparison.mean) * (difference - comparison.mean);
  if (n > 1) comparison.mean_95 = mean_interval_95(comparison.mean, std::sqrt(squares / static_cast<double>(n - 1)), n);
  std::sort(differences.begin(), differences.end());
  comparison.median = (differences[(n - 1) / 2] + differences[n / 2]) / 2;
  return comparison;
}

}  // namespace experiment
