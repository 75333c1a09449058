// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/interval.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace experiment {

namespace {

constexpr double normal_975 = 1.959963984540054;

/// Probability of exactly `heads` heads of n tosses of a fair coin.
double fair_coin_term(std::size_t n, std::size_t heads) {
  const auto tosses = static_cast<double>(n), count = static_cast<double>(heads);
  return std::exp(std::lgamma(tosses + 1) - std::lgamma(count + 1) - std::lgamma(tosses - count + 1) -
                  tosses * std::numbers::ln2);
}

}  // namespace

double student_t_975(std::size_t degrees) {
  // Hill, "Algorithm 396: Student's t-quantiles", CACM 13(10), 1970, for a two-tailed probability of 0.05.
  constexpr double p = 0.05;
  const auto n = static_cast<double>(degrees);
  if (degrees <= 1) return 1 / std::tan(p * std::numbers::pi / 2);
  if (degrees == 2) return std::sqrt(2 / (p * (2 - p)) - 2);
  const double a = 1 / (n - 0.5);
  const double b = 48 / (a * a);
  double c = ((20700 * a / b - 98) * a - 16) * a + 96.36;
  const double d = ((94.5 / (b + c) - 3) / b + 1) * std::sqrt(a * std::numbers::pi / 2) * n;
  double y = std::pow(d * p, 2 / n);
  if (y > 0.05 + a) {
    const double x = -normal_975;
    y = x * x;
    if (degrees < 5) c += 0.3 * (n - 4.5) * (x + 0.6);
    c += (((0.05 * d * x - 5) * x - 7) * x - 2) * x + b;
    y = (((((0.4 * y + 6.3) * y + 36) * y + 94.5) / c - y - 3) / b + 1) * x;
    y = std::expm1(a * y * y);
  } else {
    y = ((1 / (((n + 6) / (n * y) - 0.089 * d - 0.822) * (n + 2) * 3) + 0.5 / (n + 4)) * y - 1) * (n + 1) / (n + 2) +
        1 / y;
  }
  return std::sqrt(n * y);
}

Interval mean_interval_95(double mean, double std, std::size_t count) {
  const double half = student_t_975(count - 1) * std / std::sqrt(static_cast<double>(count));
  return {mean - half, mean + half};
}

Interval share_interval_95(std::size_t hits, std::size_t count) {
  const auto n = static_cast<double>(count);
  const double share = static_cast<double>(hits) / n;
  constexpr double z2 = normal_975 * normal_975;
  const double middle = (share + z2 / (2 * n)) / (1 + z2 / n);
  const double half = normal_975 / (1 + z2 / n) * std::sqrt(share * (1 - share) / n + z2 / (4 * n * n));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

double fair_coin_share(std::size_t n, std::size_t heads) {
  double share = 0;
  for (std::size_t k = 0; k <= std::min(heads, n); ++k) share += fair_coin_term(n, k);
  return std::min(share, 1.0);
}

Interval median_interval_95(const std::vector<double>& sorted) {
  constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
  // The median is below the value of rank r when fewer than r of the values are below it.
  const std::size_t n = sorted.size();
  std::size_t rank = 0;
  double share = 0;
  for (std::size_t k = 0; k < n / 2; ++k) {
    share += fair_coin_term(n, k);
    if (share > 0.025) break;
    rank = k + 1;
  }
  if (rank == 0) return {nothing, nothing};
  return {sorted[rank - 1], sorted[n - rank]};
}

}  // namespace experiment
