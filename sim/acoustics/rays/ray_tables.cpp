// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/rays/ray_tables.hpp"

namespace sim {

namespace {

constexpr double deepest_m = 12000;

}  // namespace

RayTables::RayTables(std::function<double(double)> speed_mps, std::vector<double> rows_m)
    : speed_mps_(std::move(speed_mps)), rows_m_(std::move(rows_m)) {}

const Eigenrays& RayTables::of(double water_m) {
  double depth_m = 50;
  while (depth_m <= water_m && depth_m < deepest_m) depth_m *= 2;
  if (depth_m > deepest_m) depth_m = deepest_m;
  const auto known = tables_.find(depth_m);
  if (known != tables_.end()) return known->second;
  return tables_.emplace(depth_m, Eigenrays(SoundProfile::fitted(speed_mps_, rows_m_, depth_m))).first->second;
}

}  // namespace sim
