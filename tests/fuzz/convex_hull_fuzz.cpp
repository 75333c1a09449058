// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/fuzz_input.hpp"
#include "tools/shoal/urdf/mass_of_shapes.hpp"

// Points on a grid: the hull is closed and convex, or there is none.

SHOAL_FUZZ_TARGET(convex_hull) {
  fuzz::Reader reader(input);
  std::vector<sim::Vector3d> points;
  while (!reader.ended() && points.size() < 300) {
    sim::Vector3d p;
    for (int i = 0; i < 3; ++i) p[i] = reader.number<std::int8_t>();
    points.push_back(p);
  }
  if (points.empty()) return;
  const std::optional<sim::Mesh> hull = tools::convex_hull(tools::outermost_points(points));
  if (!hull) return;
  fuzz::require(sim::is_closed(*hull), "a hull is closed");
  // On a grid of whole numbers, a point beyond the hull is far beyond the tolerance.
  for (const auto& t : hull->triangles) {
    const sim::Vector3d &a = hull->vertices_m[t[0]], &b = hull->vertices_m[t[1]], &c = hull->vertices_m[t[2]];
    const sim::Vector3d normal = (b - a).cross(c - a);
    for (const sim::Vector3d& p : hull->vertices_m)
      fuzz::require(normal.dot(p - a) <= 1e-6 * normal.norm(), "a hull is convex");
  }
}
