// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace experiment {

/// Point of the error curve of one run; x does not decrease along the curve.
struct CurvePoint {
  double x = 0;
  double error_m = 0;
};
using Curve = std::vector<CurvePoint>;

/// Distribution of the errors of many runs at one x.
struct Band {
  double x = 0;
  double low = 0, median = 0, high = 0;  ///< 5, 50 and 95 % of the runs
  std::size_t runs = 0;
};

/// Reads the errors of one metric from an errors.csv, over one of its columns.  Rows that cannot be read are omitted;
/// empty when the file or column does not exist.
Curve read_error_curve(const std::string& path, const std::string& metric, const std::string& x_column);

/// Returns the bands at `count` values of x from the smallest to the largest, over the runs that reach it; only where
/// at least half of the runs do.
std::vector<Band> bands_of(const std::vector<Curve>& curves, std::size_t count = 200);

}  // namespace experiment
