// SPDX-License-Identifier: BSD-3-Clause
#include "tools/shoal/urdf/convex_hull.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

namespace tools {

namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Index of the point with the largest value of a function.
template <typename Function>
std::uint32_t index_of_max(const std::vector<sim::Vector3d>& points, Function&& value_of) {
  std::uint32_t best = 0;
  double max = value_of(points[0]);
  for (std::uint32_t i = 1; i < points.size(); ++i)
    if (const double value = value_of(points[i]); value > max) {
      best = i;
      max = value;
    }
  return best;
}

/// Signed distance of a point from the plane of a triangle, positive on its outer side.
double height_over(const std::vector<sim::Vector3d>& points, const Triangle& t, const sim::Vector3d& p) {
  const sim::Vector3d &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
  return (b - a).cross(c - a).stableNormalized().dot(p - a);
}

/// Tetrahedron of four points that are far apart; std::nullopt if all points lie in one plane.
std::optional<std::vector<Triangle>> first_solid(const std::vector<sim::Vector3d>& points, double tolerance) {
  const std::uint32_t a = index_of_max(points, [](const sim::Vector3d& p) { return -p.x(); });
  const std::uint32_t b = index_of_max(points, [&](const sim::Vector3d& p) { return (p - points[a]).norm(); });
  const sim::Vector3d along = (points[b] - points[a]).stableNormalized();
  const std::uint32_t c =
      index_of_max(points, [&](const sim::Vector3d& p) { return (p - points[a]).cross(along).norm(); });
  if ((points[c] - points[a]).cross(along).norm() <= tolerance) return std::nullopt;
  const std::uint32_t d = index_of_max(points, [&](const sim::Vector3d& p) {
    return std::abs(height_over(points, {a, b, c}, p));
  });
  const double height = height_over(points, {a, b, c}, points[d]);
  if (std::abs(height) <= tolerance) return std::nullopt;
  if (height > 0) return std::vector<Triangle>{{a, c, b}, {a, b, d}, {b, c, d}, {c, a, d}};
  return std::vector<Triangle>{{a, b, c}, {b, a, d}, {c, b, d}, {a, c, d}};
}

/// Replaces the triangles that a point sees from outside by triangles from their outline to the point.
void insert(const std::vector<sim::Vector3d>& points, std::uint32_t point, double tolerance,
            std::vector<Triangle>& hull) {
  const auto is_seen = [&](const Triangle& t) { return height_over(points, t, points[point]) > tolerance; };
  const auto seen = std::partition(hull.begin(), hull.end(), [&](const Triangle& t) { return !is_seen(t); });
  if (seen == hull.end()) return;
  std::set<Edge> edges;
  for (auto t = seen; t != hull.end(); ++t)
    for (std::size_t i = 0; i < 3; ++i) edges.insert({(*t)[i], (*t)[(i + 1) % 3]});
  hull.erase(seen, hull.end());
  for (const auto& [from, to] : edges)
    if (!edges.contains({to, from})) hull.push_back({from, to, point});
}

}  // namespace

std::vector<sim::Vector3d> outermost_points(const std::vector<sim::Vector3d>& points) {
  constexpr int directions = 256;
  std::vector<sim::Vector3d> outwards{sim::Vector3d::UnitX(), sim::Vector3d::UnitY(), sim::Vector3d::UnitZ()};
  for (int i = 0; i < 3; ++i) outwards.push_back(-outwards[static_cast<std::size_t>(i)]);
  for (int i = 0; i < directions; ++i) {
    const double z = 1 - (2 * i + 1.0) / directions, level = std::sqrt(1 - z * z);
    const double turn = 2 * std::numbers::pi * i * (std::numbers::phi - 1);
    outwards.emplace_back(level * std::cos(turn), level * std::sin(turn), z);
  }
  std::set<std::uint32_t> found;
  for (const sim::Vector3d& direction : outwards)
    found.insert(index_of_max(points, [&](const sim::Vector3d& p) { return direction.dot(p); }));
  std::vector<sim::Vector3d> outermost;
  for (const std::uint32_t index : found) outermost.push_back(points[index]);
  return outermost;
}

std::optional<sim::Mesh> convex_hull(const std::vector<sim::Vector3d>& points) {
  if (points.size() < 4) return std::nullopt;
  sim::Vector3d low = points.front(), high = points.front();
  for (const sim::Vector3d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double tolerance = 1e-9 * (high - low).norm();
  std::optional<std::vector<Triangle>> hull = first_solid(points, tolerance);
  if (!hull) return std::nullopt;
  for (std::uint32_t i = 0; i < points.size(); ++i) insert(points, i, tolerance, *hull);
  // Keep only the vertices of the hull, in the order of the points.
  std::map<std::uint32_t, std::uint32_t> numbers;
  for (const Triangle& t : *hull)
    for (const std::uint32_t corner : t) numbers[corner] = 0;
  sim::Mesh mesh;
  for (auto& [point, number] : numbers) {
    number = static_cast<std::uint32_t>(mesh.vertices_m.size());
    mesh.vertices_m.push_back(points[point]);
  }
  for (const Triangle& t : *hull) mesh.triangles.push_back({numbers[t[0]], numbers[t[1]], numbers[t[2]]});
  if (!sim::is_closed(mesh) || !(sim::solid_of(mesh).volume_m3 > 0)) return std::nullopt;  // rounding
  return mesh;
}

}  // namespace tools
