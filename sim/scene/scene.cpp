// SPDX-License-Identifier: BSD-3-Clause
#include "sim/scene/scene.hpp"

namespace sim {

void Scene::cast(std::span<const Ray> rays, const RayFilter& filter, std::span<RayHit> hits) const {
  for (std::size_t i = 0; i < rays.size(); ++i)
    hits[i] = cast(rays[i].origin_W, rays[i].direction_W, rays[i].range_max_m, filter).value_or(RayHit{});
}

void Scene::find_blocked(std::span<const Ray> rays, const RayFilter& filter, std::span<std::uint8_t> blocked) const {
  for (std::size_t i = 0; i < rays.size(); ++i)
    blocked[i] = cast(rays[i].origin_W, rays[i].direction_W, rays[i].range_max_m, filter).has_value();
}

bool Scene::occluded(const Vector3d& from_W, const Vector3d& to_W, const RayFilter& filter) const {
  const Vector3d d = to_W - from_W;
  const double distance_m = d.norm();
  return distance_m > 0 && cast(from_W, d / distance_m, distance_m, filter).has_value();
}

}  // namespace sim
