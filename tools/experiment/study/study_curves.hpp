// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace tools {

/// Errors of one run along x, which does not fall.
struct CurvePoint {
  double x = 0;
  double error_m = 0;
};
using Curve = std::vector<CurvePoint>;

/// Where the errors of many runs lie at one x.
struct Band {
  double x = 0;
  double low = 0, median = 0, high = 0;  ///< 5, 50 and 95 % of the runs
  std::size_t runs = 0;
};

/// The errors of one metric in an errors.csv, over one of its columns.  Rows that cannot be read are left out; empty
/// when there is no such file or column.
Curve read_error_curve(const std::string& path, const std::string& metric, const std::string& x_column);

/// At `count` x from the smallest to the largest, those runs that reach it; only where half of the runs do.
std::vector<Band> bands_of(const std::vector<Curve>& curves, std::size_t count = 200);

}  // namespace tools
