// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "sim/acoustics/rays/eigenrays.hpp"

namespace sim {

/// Tables of rays of one water, made when they are first needed: one for each doubling of the depth, since the layers
/// of the deep sea would only slow the search in shallow water.
class RayTables {
 public:
  /// `speed_mps`: speed of sound by depth, smooth between the depths `rows_m`.
  RayTables(std::function<double(double)> speed_mps, std::vector<double> rows_m);
  /// Table for water of this depth, m; infinite: no bottom.
  const Eigenrays& of(double water_m);

 private:
  std::function<double(double)> speed_mps_;
  std::vector<double> rows_m_;
  std::map<double, Eigenrays> tables_;  // by depth
};

}  // namespace sim
