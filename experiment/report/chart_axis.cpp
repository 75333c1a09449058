// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/report/chart_axis.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace experiment {

namespace {

/// Most intervals between ticks within the range of the values.
constexpr double max_intervals = 5;
/// Values that differ by less than this share of them are drawn as one.
constexpr double rounding = 1e-9;

/// Returns the smallest of 1, 2 and 5 times a power of ten that is not below a positive value.
double nice_above(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double digit : {1, 2, 5})
    if (digit * power >= value * (1 - rounding)) return digit * power;
  return 10 * power;
}

double nice_below(double value) {
  const double power = std::pow(10, std::floor(std::log10(value) + rounding));
  for (const double digit : {5, 2})
    if (digit * power <= value * (1 + rounding)) return digit * power;
  return power;
}

}  // namespace

void ChartAxis::add(double value) {
  if (!std::isfinite(value) || (log_ && value <= 0)) return;
  low_ = std::min(low_, value);
  high_ = std::max(high_, value);
  whole_ = whole_ && std::round(value) == value;
}

std::vector<double> ChartAxis::ticks() const {
  if (log_) return log_ticks();
  double low = low_, high = high_;
  const double size = std::max(std::fabs(low), std::fabs(high));
  // One value lies in the middle.
  if (!(high - low > rounding * size)) {
    const double half = size > 0 ? nice_above(size / 10) : 1;
    low -= half;
    high += half;
  }
  const double step = std::max(nice_above((high - low) / max_intervals), whole_ ? 1.0 : 0.0);
  const double first = std::floor(low / step + 1e-6), last = std::ceil(high / step - 1e-6);
  std::vector<double> ticks;
  for (double number = first; number <= last; ++number) ticks.push_back(number * step);
  return ticks;
}

std::vector<double> ChartAxis::log_ticks() const {
  const double low = nice_below(low_), high = std::max(nice_above(high_), nice_above(2 * low));
  // 1, 2, 5 of each decade; over many decades only powers of ten, and not all of them.
  const double decades = std::log10(high / low);
  if (decades <= 2) {
    std::vector<double> ticks{low};
    while (ticks.back() < high * (1 - rounding)) ticks.push_back(nice_above(1.5 * ticks.back()));
    return ticks;
  }
  const double every = std::ceil(decades / max_intervals);
  const double first = std::floor(std::log10(low) + rounding), last = std::ceil(std::log10(high) - rounding);
  std::vector<double> ticks;
  for (double power = first; power < last + every; power += every) ticks.push_back(std::pow(10, power));
  return ticks;
}

double share_of_axis(const std::vector<double>& ticks, bool log, double value) {
  const auto at = [log](double x) { return log ? std::log(x) : x; };
  return (at(value) - at(ticks.front())) / (at(ticks.back()) - at(ticks.front()));
}

std::string tick_text(const std::vector<double>& ticks, double tick) {
  if (tick == 0) return "0";
  double step = std::fabs(tick);
  for (std::size_t i = 1; i < ticks.size(); ++i) step = std::min(step, ticks[i] - ticks[i - 1]);
  const double size = std::max(std::fabs(ticks.front()), std::fabs(ticks.back()));
  if (size < 1e6 && step >= 1e-4)
    return fmt::format("{:.{}f}", tick, static_cast<int>(std::max(0.0, std::ceil(-std::log10(step) - rounding))));
  return fmt::format("{:.{}g}", tick, static_cast<int>(std::clamp(std::log10(size / step) + 2, 1.0, 15.0)));
}

}  // namespace experiment
