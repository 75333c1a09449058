// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace experiment {

/// Axis of a chart, from one tick to another: multiples of 1, 2 or 5 times a power of ten, on a logarithmic axis such
/// numbers themselves.  Between whole numbers ticks are whole.
class ChartAxis {
 public:
  explicit ChartAxis(bool log = false) : log_(log) {}

  /// Makes a value part of the range; one that is not finite, or not positive on a logarithmic axis, is left out.
  void add(double value);
  bool empty() const { return low_ > high_; }
  /// Returns the ticks, in ascending order, the first at or below all values and the last at or above them; at least
  /// two.  Not of an empty axis.
  std::vector<double> ticks() const;

 private:
  std::vector<double> log_ticks() const;

  bool log_, whole_ = true;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -std::numeric_limits<double>::infinity();
};

/// Returns where a value lies between the first tick, 0, and the last one, 1.
double share_of_axis(const std::vector<double>& ticks, bool log, double value);

/// Returns the text of a tick, with the digits that distinguish it from its neighbors.
std::string tick_text(const std::vector<double>& ticks, double tick);

}  // namespace experiment
