// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "sim/acoustics/rays/eigenrays.hpp"

namespace sim {

/// Tables of rays of one water, made when they are first needed: one for each doubling of the depth, since the layers
/// of the deep sea would only slow the search in shallow water.  Threads may share it.
class RayTables {
 public:
  /// `speed_mps`: speed of sound by depth, smooth between the depths `rows_m`.
  RayTables(std::function<double(double)> speed_mps, std::vector<double> rows_m);
  /// Table for water of this depth, m; infinite: no bottom.
  const Eigenrays& of(double water_m);

 private:
  static constexpr std::size_t depths = 9;  // 50 m to 12 km

  std::function<double(double)> speed_mps_;
  std::vector<double> rows_m_;
  std::mutex making_;
  std::array<std::unique_ptr<const Eigenrays>, depths> made_;   // by depth
  std::array<std::atomic<const Eigenrays*>, depths> tables_{};  // the same, null: not yet made
};

}  // namespace sim
