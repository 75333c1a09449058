// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/rays/ray_tables.hpp"

#include <algorithm>

namespace sim {

namespace {

constexpr double deepest_m = 12000;

}  // namespace

RayTables::RayTables(std::function<double(double)> speed_mps, std::vector<double> rows_m)
    : speed_mps_(std::move(speed_mps)), rows_m_(std::move(rows_m)) {}

const Eigenrays& RayTables::of(double water_m) {
  double depth_m = 50;
  std::size_t number = 0;
  for (; depth_m <= water_m && depth_m < deepest_m; depth_m *= 2) ++number;
  if (const Eigenrays* const known = tables_[number].load(std::memory_order_acquire)) return *known;
  const std::lock_guard lock(making_);
  if (made_[number] == nullptr) {
    const double to_m = std::min(depth_m, deepest_m);
    made_[number] = std::make_unique<const Eigenrays>(SoundProfile::fitted(speed_mps_, rows_m_, to_m));
    tables_[number].store(made_[number].get(), std::memory_order_release);
  }
  return *made_[number];
}

}  // namespace sim
