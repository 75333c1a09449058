// SPDX-License-Identifier: BSD-3-Clause
#include "devices/ranging/ray_filter.hpp"

namespace devices {

sim::RayFilter make_ray_filter(const sim::PhysicsWorld& physics, sim::RayKind kind,
                               const std::vector<std::string>& see_through, int own_group, bool sees_own_vehicle) {
  sim::RayFilter filter;
  filter.kind = kind;
  for (const std::string& category : see_through) filter.categories &= ~physics.category_bit(category);
  if (!sees_own_vehicle) filter.exclude_group = own_group;
  return filter;
}

}  // namespace devices
