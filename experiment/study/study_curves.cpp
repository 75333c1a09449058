// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/study/study_curves.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>

#include "experiment/files/csv.hpp"
#include "experiment/study/study_results.hpp"
#include "sim/base/number.hpp"

namespace experiment {

namespace {

/// Linear interpolation; nothing before the first or after the last point.
std::optional<double> error_at(const Curve& curve, double x) {
  if (x < curve.front().x || x > curve.back().x) return std::nullopt;
  const auto after =
      std::lower_bound(curve.begin(), curve.end(), x, [](const CurvePoint& point, double at) { return point.x < at; });
  if (after == curve.begin() || after->x == x) return after->error_m;
  const auto before = after - 1;
  return before->error_m + (x - before->x) / (after->x - before->x) * (after->error_m - before->error_m);
}

}  // namespace

Curve read_error_curve(const std::string& path, const std::string& metric, const std::string& x_column) {
  std::ifstream in(path);
  std::string line;
  if (!std::getline(in, line)) return {};
  const std::vector<std::string> head = csv_fields(line).value_or(std::vector<std::string>{});
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(head.begin(), head.end(), name) - head.begin());
  };
  const std::size_t x = column(x_column), error = column("error_m"), name = column("metric");
  const std::size_t last = std::max({x, error, name});
  if (last >= head.size()) return {};
  Curve curve;
  while (std::getline(in, line)) {
    const auto fields = csv_fields(line);
    if (!fields || fields->size() <= last || (*fields)[name] != metric) continue;
    const CurvePoint point{sim::read_number((*fields)[x]).value_or(no_figure),
                           sim::read_number((*fields)[error]).value_or(no_figure)};
    if (std::isfinite(point.x) && std::isfinite(point.error_m)) curve.push_back(point);
  }
  // At rest many estimates have the same distance; they stay in the order of time.
  std::stable_sort(curve.begin(), curve.end(), [](const CurvePoint& a, const CurvePoint& b) { return a.x < b.x; });
  return curve;
}

std::vector<Band> bands_of(const std::vector<Curve>& curves, std::size_t count) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Curve& curve : curves) {
    if (curve.empty()) continue;
    low = std::min(low, curve.front().x);
    high = std::max(high, curve.back().x);
  }
  std::vector<Band> bands;
  for (std::size_t i = 0; low <= high && i < count; ++i) {
    // The weighted sum reaches both ends exactly.
    const double share = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0;
    const double x = (1 - share) * low + share * high;
    std::vector<double> errors;
    for (const Curve& curve : curves)
      if (const auto error = curve.empty() ? std::nullopt : error_at(curve, x)) errors.push_back(*error);
    if (errors.empty() || 2 * errors.size() < curves.size()) continue;
    std::sort(errors.begin(), errors.end());
    bands.push_back({x, quantile(errors, 0.05), quantile(errors, 0.5), quantile(errors, 0.95), errors.size()});
  }
  return bands;
}

}  // namespace experiment
