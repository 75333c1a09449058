// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/rays/caustic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>

namespace sim {

CausticChange caustic_change(double apart_rad) {
  constexpr double pi = std::numbers::pi;
  const double z = std::max(apart_rad / 2, 1e-30);
  // Beyond, the change is less than 1e-5 and 1 mrad.
  constexpr double far = 100;
  if (z > far) return {};
  const double j = std::cyl_bessel_j(1.0 / 3, z), y = std::cyl_neumann(1.0 / 3, z);
  return {pi * z / 2 * (j * j + y * y), std::remainder(std::atan2(y, j) + pi / 6 - (z - pi / 4), 2 * pi)};
}

namespace {

/// Whether two rays are of one family, reversed as often by the same.
bool same_kind(const std::vector<SoundRay>& rays, const std::vector<RayRoot>& roots, std::size_t i, std::size_t j) {
  return roots[i].family == roots[j].family && roots[i].cycles == roots[j].cycles &&
         rays[i].surface_bounces == rays[j].surface_bounces && rays[i].bottom_bounces == rays[j].bottom_bounces;
}

}  // namespace

void merge_false_rays(std::vector<SoundRay>& rays, std::vector<RayRoot>& roots) {
  std::vector<std::size_t> order(rays.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t i) {
    return std::tuple(roots[i].family, roots[i].cycles, rays[i].surface_bounces, rays[i].bottom_bounces, roots[i].xi);
  };
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return key(i) < key(j); });
  std::vector<std::size_t> kept;
  for (std::size_t first = 0, last = 0; first < order.size(); first = last + 1) {
    const double near = roots[order[first]].thin;
    for (last = first; last + 1 < order.size() && same_kind(rays, roots, order[last], order[last + 1]) &&
                       roots[order[last + 1]].xi - roots[order[last]].xi < near;)
      ++last;
    // The reach crosses the range up and down in turn: an even number in all is a caustic, an odd one is one ray.
    if ((last - first) % 2 == 1) {
      kept.push_back(order[first]);
      kept.push_back(order[last]);
    } else {
      kept.push_back(order[first]);
    }
  }
  if (kept.size() == rays.size()) return;
  std::sort(kept.begin(), kept.end());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    rays[i] = rays[kept[i]];
    roots[i] = roots[kept[i]];
  }
  rays.resize(kept.size());
  roots.resize(kept.size());
}

void pair_twins(std::vector<SoundRay>& rays, const std::vector<RayRoot>& roots) {
  while (true) {
    std::size_t first = rays.size(), second = 0;
    double closest_s = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < rays.size(); ++i) {
      if (rays[i].twin) continue;
      for (std::size_t j = i + 1; j < rays.size(); ++j) {
        // The reach has an extreme between them.
        const bool merges = (roots[i].slope < 0) != (roots[j].slope < 0);
        if (rays[j].twin || !merges || !same_kind(rays, roots, i, j)) continue;
        const double apart_s = std::abs(rays[j].travel_time_s - rays[i].travel_time_s);
        if (apart_s >= closest_s) continue;
        closest_s = apart_s;
        first = i, second = j;
      }
    }
    if (first == rays.size()) return;
    // Time changes by xi with the range, so twins are apart by the area between the reach and the range over xi.  Of a
    // parabola with this second derivative it is two thirds of the cube of the slope at both ends over its square.
    const double slopes = std::abs(roots[first].slope) + std::abs(roots[second].slope);
    const double bend = slopes / std::max(std::abs(roots[first].xi - roots[second].xi), 1e-300);
    const double fold = std::max(std::cbrt(1.5 * bend * bend * closest_s), 1e-300);
    const double later_s = rays[second].travel_time_s - rays[first].travel_time_s;
    for (const std::size_t i : {first, second}) {
      SoundRay& ray = rays[i];
      ray.twin = SoundRay::Twin{i == first ? later_s : -later_s, roots[i].power_by_slope / fold};
      ray.power_per_m2 = roots[i].power_by_slope / std::max(std::abs(roots[i].slope), 1e-300);
      // The later one has passed the caustic.
      ray.caustics = std::max(0, ray.turns - (ray.twin->later_s > 0));
    }
  }
}

}  // namespace sim
