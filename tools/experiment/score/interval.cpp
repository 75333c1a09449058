// SPDX-License-Identifier: BSD-3-Clause
#include "tools/experiment/score/interval.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tools {

namespace {

constexpr double normal_975 = 1.959963984540054;

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

}  // namespace tools
