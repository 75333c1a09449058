// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/convex_hull.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/config/diagnostics.hpp"
#include "tools/shoal/urdf/imported_meshes.hpp"

namespace {

using sim::Vector3d;

TEST(ConvexHull, OfABoxHasTwelveTriangles) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 8; ++i) points.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
  points.emplace_back(0.5, 0.5, 0.5);  // inside
  const std::optional<sim::Mesh> hull = tools::convex_hull(points);
  ASSERT_TRUE(hull);
  EXPECT_EQ(hull->vertices_m.size(), 8u);
  EXPECT_EQ(hull->triangles.size(), 12u);
  EXPECT_NEAR(sim::solid_of(*hull).volume_m3, 1, 1e-12);
}

TEST(ConvexHull, OfPointsOnASphereHasTwiceAsManyTrianglesLessFour) {
  // Euler: 2 n - 4 triangles of n points in general position on a convex surface.
  std::vector<Vector3d> points;
  for (int i = 0; i < 500; ++i)
    points.push_back(Vector3d(std::sin(7.1 * i + 1), std::sin(3.3 * i * i), std::cos(1.7 * i)).normalized());
  const std::optional<sim::Mesh> hull = tools::convex_hull(points);
  ASSERT_TRUE(hull);
  EXPECT_EQ(hull->vertices_m.size(), 500u);
  EXPECT_EQ(hull->triangles.size(), 996u);
  EXPECT_TRUE(sim::is_closed(*hull));
  for (const auto& t : hull->triangles) {
    const Vector3d &a = hull->vertices_m[t[0]], &b = hull->vertices_m[t[1]], &c = hull->vertices_m[t[2]];
    const Vector3d normal = (b - a).cross(c - a).normalized();
    for (const Vector3d& p : points) ASSERT_LE(normal.dot(p - a), 1e-8);
  }
}

TEST(ConvexHull, OfPointsInAPlaneIsNone) {
  EXPECT_FALSE(tools::convex_hull({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {0.5, 0.3, 1}}));
  EXPECT_FALSE(tools::convex_hull({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}));
  EXPECT_FALSE(tools::convex_hull({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}));
}

TEST(ConvexHull, OutermostPointsKeepTheBoundingBox) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 5000; ++i)
    points.emplace_back(std::sin(7.1 * i), 0.01 * std::sin(3.3 * i), 3 * std::cos(1.7 * i));
  const std::vector<Vector3d> outermost = tools::outermost_points(points);
  EXPECT_LE(outermost.size(), 262u);
  const auto extent = [](const std::vector<Vector3d>& all, int axis) {
    const auto [low, high] = std::minmax_element(
        all.begin(), all.end(), [&](const Vector3d& a, const Vector3d& b) { return a[axis] < b[axis]; });
    return (*high)[axis] - (*low)[axis];
  };
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(extent(outermost, axis), extent(points, axis));
}

}  // namespace
