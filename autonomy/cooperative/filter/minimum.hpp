// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace navigation {

struct Minimum {
  double at = 0;
  double value = 0;
};

/// Returns the minimum of a function of one number between two limits: the best of a grid of 32, refined by golden
/// section.
template <class Function>
Minimum minimum_between(double low, double high, const Function& function) {
  constexpr int grid = 32;
  constexpr double golden = 0.6180339887498949;
  const double step = (high - low) / grid;
  int best = 0;
  double best_value = function(low);
  for (int i = 1; i <= grid; ++i) {
    const double value = function(low + i * step);
    if (value < best_value) {
      best = i;
      best_value = value;
    }
  }
  double a = low + (best > 0 ? best - 1 : 0) * step;
  double b = low + (best < grid ? best + 1 : grid) * step;
  double c = b - golden * (b - a), d = a + golden * (b - a);
  double at_c = function(c), at_d = function(d);
  for (int i = 0; i < 30; ++i) {
    if (at_c < at_d) {
      b = d;
      d = c;
      at_d = at_c;
      c = b - golden * (b - a);
      at_c = function(c);
    } else {
      a = c;
      c = d;
      at_c = at_d;
      d = a + golden * (b - a);
      at_d = function(d);
    }
  }
  const double middle = 0.5 * (a + b);
  return {middle, function(middle)};
}

}  // namespace navigation
