// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rays/ray_bundle.hpp"

#include <algorithm>
#include <cmath>

namespace sim {

RayBundle::RayBundle(std::span<const Ray> rays) {
  if (rays.empty()) return;
  // The rays that differ most from the middle one.
  const Ray& middle = rays[rays.size() / 2];
  double lowest_cosine = 1, square_m2 = 0, range_m = 0;
  for (const Ray& ray : rays) {
    range_m = std::max(range_m, ray.range_max_m);
    lowest_cosine = std::min(lowest_cosine, ray.direction_W.dot(middle.direction_W));
    square_m2 = std::max(square_m2, (ray.origin_W - middle.origin_W).squaredNorm());
  }
  // Margins for rounding; the cosine alone would lose small angles.
  constexpr double least_cosine = 0.866, margin = 1e-6;
  narrow_ = lowest_cosine > least_cosine && std::isfinite(square_m2);
  if (!narrow_) return;
  origin_W_ = middle.origin_W;
  axis_W_ = middle.direction_W;
  range_m_ = (1 + margin) * range_m;
  radius_m_ = (1 + margin) * std::sqrt(square_m2) + margin * (1 + origin_W_.norm() * 1e-6);
  slope_ = (1 + margin) * std::sqrt(std::max(0.0, 1 - lowest_cosine * lowest_cosine)) / lowest_cosine + margin;
}

}  // namespace sim
