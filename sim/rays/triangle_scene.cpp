// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rays/triangle_scene.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "sim/rays/float_rays.hpp"

namespace sim {

/// Query of a packet: rays in the frame of the mesh, relative to its center.  Callbacks get it by its first member.
struct TriangleScene::Query {
  Query(const TriangleScene& scene_, const RayShape& shape, const RayPacket& rays_, unsigned lanes)
      : embree(rays_.coherent), scene(scene_), rays(rays_), floats(scene_.radius_m_) {
    transform_to(shape, rays, from, direction);
    floats.aim(from, direction, rays.range_m, lanes);
    for (int i = 0; i < RayPacket::size; ++i) {
      nearest[i] = std::numeric_limits<float>::infinity();
      found[i] = 0;
    }
  }
  Vector3d from_M(int lane) const { return {from[0][lane], from[1][lane], from[2][lane]}; }
  Vector3d direction_M(int lane) const { return {direction[0][lane], direction[1][lane], direction[2][lane]}; }
  /// Whether the triangle of a hit is the only one at about this range.
  bool is_clear(const FloatRays::TriangleHit& found_hit) const {
    const auto min = static_cast<float>(scene.clearance_);
    return found_hit.u > min && found_hit.v > min && 1 - found_hit.u - found_hit.v > min && !at_start(found_hit.tfar);
  }
  /// Whether a hit is so near to the start that rounding may put it on the wrong side.
  bool at_start(float tfar) const { return tfar <= 4 * floats.margin_m(); }
  void note(int lane, float tfar, std::uint32_t triangle);

  RayQuery embree;  // first: see RayQuery
  const TriangleScene& scene;
  const RayPacket& rays;
  unsigned hit = 0;  // lanes
  double from[3][RayPacket::size], direction[3][RayPacket::size];
  FloatRays floats;

  /// Triangles that a ray hits at about the same range: those that share the edge or corner that it hits.  The nearest
  /// one is determined in double precision when all are known, so that the order of Embree's results has no effect.
  struct Candidate {
    float tfar;
    std::uint32_t triangle;
    bool operator<(const Candidate& other) const {
      return tfar != other.tfar ? tfar < other.tfar : triangle < other.triangle;
    }
  };
  static constexpr int max = 8;
  Candidate candidates[RayPacket::size][max];
  int found[RayPacket::size];
  float nearest[RayPacket::size];
};

void TriangleScene::Query::note(int lane, float tfar, std::uint32_t triangle) {
  Candidate* const all = candidates[lane];
  int& count = found[lane];
  if (tfar + floats.margin_m() < nearest[lane]) count = 0;
  nearest[lane] = std::min(nearest[lane], tfar);
  if (count < max) {
    all[count++] = {tfar, triangle};
    return;
  }
  // Replace the farthest candidate, independent of the order of arrival.
  Candidate* const last = std::max_element(all, all + max);
  *last = std::min(*last, Candidate{tfar, triangle});
}

TriangleScene::TriangleScene(const Mesh& mesh) : mesh_(mesh), scene_(rtcNewScene(embree_device())) {
  check_embree();
  // Bounding box.
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::max()), high = -low;
  for (const Vector3d& vertex : mesh.vertices_m) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  if (mesh.vertices_m.empty()) low = high = Vector3d::Zero();
  center_m_ = (low + high) / 2;
  half_extents_m_ = (high - low) / 2;
  radius_m_ = half_extents_m_.norm();
  clearance_ = find_clearance(low, high);

  const EmbreeGeometryHandle geometry(rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_TRIANGLE));
  // Copy the vertices relative to the center, and share the triangles.
  auto* vertices =
      static_cast<float*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                  3 * sizeof(float), std::max<std::size_t>(1, mesh.vertices_m.size())));
  check_embree();
  for (const Vector3d& vertex : mesh.vertices_m)
    for (int i = 0; i < 3; ++i) *vertices++ = static_cast<float>(vertex[i] - center_m_[i]);
  if (!mesh.triangles.empty())
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                               sizeof mesh.triangles[0], mesh.triangles.size());
  // Set the callback, and build the tree.
  rtcSetGeometryOccludedFilterFunction(geometry.get(), filter_blocked);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene_.get(), geometry.get());
  // Robust: no ray passes between two adjacent triangles.  The other: cast() sets a filter only where it needs one.
  rtcSetSceneFlags(scene_.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RayQuery::filter_flag));
  commit_alone(scene_.get());
}

namespace {

/// Returns the same number with the other sign for the edge in the other direction.
std::int64_t number_of_edge(std::uint32_t from, std::uint32_t to) {
  const std::uint64_t low = std::min(from, to), high = std::max(from, to);
  std::uint64_t mixed = (high << 32 | low) * 0x9e3779b97f4a7c15u;  // spread over all bits, as splitmix64 does
  mixed = (mixed ^ mixed >> 30) * 0xbf58476d1ce4e5b9u;
  mixed ^= mixed >> 27;
  return static_cast<std::int64_t>(from < to ? mixed : 0 - mixed);
}

}  // namespace

/// Seen from above, the triangles of a terrain cover a rectangle once.  Then two points of a ray on two triangles are
/// not nearer to each other than the first one is to the edges of its triangle, seen from above.
///
/// That they cover it once follows from: all of them turn the same way, those edges that have no neighbor are on the
/// rectangle's border (so that each point within is covered the same number of times), and their area is that of the
/// rectangle.
double TriangleScene::find_clearance(const Vector3d& low, const Vector3d& high) const {
  constexpr double unknown = std::numeric_limits<double>::infinity();
  const auto on_border = [&](const Vector3d& a, const Vector3d& b) {
    return (a.x() == b.x() && (a.x() == low.x() || a.x() == high.x())) ||
           (a.y() == b.y() && (a.y() == low.y() || a.y() == high.y()));
  };
  double area_m2 = 0, height_m = unknown;
  std::uint64_t edges = 0;  // sum over all that are not on the border
  for (const auto& corners : mesh_.triangles) {
    const Vector3d* at[3] = {&mesh_.vertices_m[corners[0]], &mesh_.vertices_m[corners[1]],
                             &mesh_.vertices_m[corners[2]]};
    const double twice_m2 =
        (at[1]->x() - at[0]->x()) * (at[2]->y() - at[0]->y()) - (at[1]->y() - at[0]->y()) * (at[2]->x() - at[0]->x());
    if (!(twice_m2 > 0)) return unknown;
    area_m2 += twice_m2 / 2;
    double longest_m2 = 0;
    for (int i = 0; i < 3; ++i) {
      const int next = (i + 1) % 3;
      longest_m2 = std::max(longest_m2, (at[next]->head<2>() - at[i]->head<2>()).squaredNorm());
      if (!on_border(*at[i], *at[next]))
        edges += static_cast<std::uint64_t>(
            number_of_edge(corners[static_cast<std::size_t>(i)], corners[static_cast<std::size_t>(next)]));
    }
    height_m = std::min(height_m, twice_m2 / std::sqrt(longest_m2));
  }
  const double rectangle_m2 = (high.x() - low.x()) * (high.y() - low.y());
  if (edges != 0 || !(std::abs(area_m2 - rectangle_m2) < 1e-6 * rectangle_m2)) return unknown;
  // Hits are rounded by less than the margin, and so are the candidates of cast_near_edges() apart.
  const double clearance = 4 * FloatRays(radius_m_).margin_m() / height_m;
  constexpr double max_clearance = 0.05;  // beyond it too few hits are clear
  return clearance < max_clearance ? clearance : unknown;
}

/// Range to the plane of the triangle, limited to the extent of the triangle along the ray: for a triangle seen edge-on
/// the range to the plane is inaccurate.
double TriangleScene::find_range(const Vector3d& from_M, const Vector3d& direction_M, std::uint32_t triangle) const {
  const auto& corners = mesh_.triangles[triangle];
  const Vector3d from = from_M + center_m_;
  const Vector3d a = mesh_.vertices_m[corners[0]] - from, b = mesh_.vertices_m[corners[1]] - from,
                 c = mesh_.vertices_m[corners[2]] - from;
  const Vector3d normal = (b - a).cross(c - a);
  const double rate = normal.dot(direction_M);
  const double da = a.dot(direction_M), db = b.dot(direction_M), dc = c.dot(direction_M);
  const double low = std::min(std::min(da, db), dc), high = std::max(std::max(da, db), dc);
  return rate == 0 ? (low + high) / 2 : std::clamp(normal.dot(a) / rate, low, high);
}

void TriangleScene::filter_cast(const RTCFilterFunctionNArguments* arguments) {
  Query& query = *reinterpret_cast<Query*>(arguments->context);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    const int lane = static_cast<int>(RTCRayN_id(arguments->ray, n, i));
    const std::uint32_t triangle = RTCHitN_primID(arguments->hit, n, i);
    float& tfar = RTCRayN_tfar(arguments->ray, n, i);
    if (query.at_start(tfar) && !(query.scene.find_range(query.from_M(lane), query.direction_M(lane), triangle) >= 0)) {
      arguments->valid[i] = 0;
      continue;
    }
    query.note(lane, tfar, triangle);
    // The triangle is used in double precision after this query.
    __builtin_prefetch(&query.scene.mesh_.triangles[triangle]);
    // Keep the ray long enough for all candidates.
    tfar = query.nearest[lane] + query.floats.margin_m();
  }
}

void TriangleScene::prefetch(std::uint32_t triangle) const {
  for (const std::uint32_t corner : mesh_.triangles[triangle]) __builtin_prefetch(&mesh_.vertices_m[corner]);
}

unsigned TriangleScene::cast(const RayShape& shape, RayPacket& rays, unsigned lanes) const {
  if (!std::isfinite(clearance_)) return cast_near_edges(shape, rays, lanes);
  Query query(*this, shape, rays, lanes);
  query.floats.intersect(scene_.get(), query.embree);
  // Sort the lanes into those with a clear hit and others, and load the triangles of the former into the cache.
  unsigned clear = 0, unclear = 0;
  for (unsigned rest = lanes; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    const FloatRays::TriangleHit found = query.floats.triangle_hit(lane);
    if (!found.any) continue;
    (query.is_clear(found) ? clear : unclear) |= 1u << lane;
    __builtin_prefetch(&mesh_.triangles[found.triangle]);
  }
  for (unsigned rest = clear; rest != 0; rest &= rest - 1)
    prefetch(query.floats.triangle_hit(std::countr_zero(rest)).triangle);
  unsigned hit = 0;
  for (; clear != 0; clear &= clear - 1) {
    const int lane = std::countr_zero(clear);
    const std::uint32_t triangle = query.floats.triangle_hit(lane).triangle;
    const double range_m = find_range(query.from_M(lane), query.direction_M(lane), triangle);
    if (!(range_m >= 0) || !rays.nearer(lane, range_m, shape.part)) continue;
    rays.hit(lane, range_m, shape, triangle);
    hit |= 1u << lane;
  }
  return unclear == 0 ? hit : hit | cast_near_edges(shape, rays, unclear);
}

/// Casts rays that may hit several triangles at about the same range.
unsigned TriangleScene::cast_near_edges(const RayShape& shape, RayPacket& rays, unsigned lanes) const {
  Query query(*this, shape, rays, lanes);
  query.embree.set_filter(filter_cast);
  query.floats.intersect(scene_.get(), query.embree);
  for (unsigned rest = lanes; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    for (int i = 0; i < query.found[lane]; ++i) prefetch(query.candidates[lane][i].triangle);
  }
  unsigned hit = 0;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    for (int i = 0; i < query.found[lane]; ++i) {
      // Compute the candidate in double precision, and keep the nearest.
      const auto [tfar, triangle] = query.candidates[lane][i];
      if (tfar > query.nearest[lane] + query.floats.margin_m()) continue;
      const double range_m = find_range(query.from_M(lane), query.direction_M(lane), triangle);
      // At equal range the lower triangle number counts.
      const bool same = range_m == rays.range_m[lane] && rays.part[lane] == shape.part;
      if (!(range_m >= 0) || !(rays.nearer(lane, range_m, shape.part) || (same && triangle < rays.triangle[lane])))
        continue;
      rays.hit(lane, range_m, shape, triangle);
      hit |= 1u << lane;
    }
  }
  return hit;
}

void TriangleScene::filter_blocked(const RTCFilterFunctionNArguments* arguments) {
  Query& query = *reinterpret_cast<Query*>(arguments->context);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    const int lane = static_cast<int>(RTCRayN_id(arguments->ray, n, i));
    const float tfar = RTCRayN_tfar(arguments->ray, n, i);
    const double limit_m = query.rays.range_m[lane];
    bool blocked = true;
    // Check in double precision near both ends of the ray; in between rounding has no effect.
    if (query.at_start(tfar) || tfar + 4 * query.floats.margin_m() >= query.floats.limit_m(lane, limit_m)) {
      const double range_m =
          query.scene.find_range(query.from_M(lane), query.direction_M(lane), RTCHitN_primID(arguments->hit, n, i));
      blocked = range_m >= 0 && range_m <= limit_m;
    }
    if (blocked) query.hit |= 1u << lane;
    arguments->valid[i] = blocked ? -1 : 0;
  }
}

unsigned TriangleScene::find_blocked(const RayShape& shape, const RayPacket& rays, unsigned lanes) const {
  Query query(*this, shape, rays, lanes);
  query.floats.find_occluded(scene_.get(), query.embree);
  return query.hit;
}

Vector3d TriangleScene::normal(std::uint32_t triangle) const {
  const auto& corners = mesh_.triangles[triangle];
  const Vector3d& a = mesh_.vertices_m[corners[0]];
  return (mesh_.vertices_m[corners[1]] - a).cross(mesh_.vertices_m[corners[2]] - a).normalized();
}

}  // namespace sim
