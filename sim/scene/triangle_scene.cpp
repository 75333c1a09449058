#include "sim/scene/triangle_scene.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "sim/scene/float_rays.hpp"

namespace sim {

/// Rays in the frame of the mesh, from its centre.  Callbacks know it by its first member.
struct TriangleScene::Query {
  Query(const TriangleScene& scene_, const RayShape& shape_, RayPacket& rays_, unsigned lanes)
      : scene(scene_), shape(shape_), rays(rays_), floats(scene_.radius_m_, lanes) {
    rtcInitIntersectContext(&context);
    const auto& a = shape.axes;
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      const double x = rays.origin[0][lane] - shape.center[0];
      const double y = rays.origin[1][lane] - shape.center[1];
      const double z = rays.origin[2][lane] - shape.center[2];
      const double vx = rays.direction[0][lane], vy = rays.direction[1][lane], vz = rays.direction[2][lane];
      for (int i = 0; i < 3; ++i) {
        from[lane][i] = a[3 * i] * x + a[3 * i + 1] * y + a[3 * i + 2] * z;
        direction[lane][i] = a[3 * i] * vx + a[3 * i + 1] * vy + a[3 * i + 2] * vz;
      }
      floats.aim(lane, from[lane][0], from[lane][1], from[lane][2], direction[lane][0], direction[lane][1],
                 direction[lane][2], rays.range_m[lane]);
    }
  }

  RTCIntersectContext context;
  const TriangleScene& scene;
  const RayShape& shape;
  RayPacket& rays;
  unsigned hit = 0;  // lanes
  double from[RayPacket::size][3], direction[RayPacket::size][3];
  FloatRays floats;
};

TriangleScene::TriangleScene(const Mesh& mesh) : mesh_(mesh), scene_(rtcNewScene(embree_device())) {
  check_embree();
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::max()), high = -low;
  for (const Vector3d& vertex : mesh.vertices_m) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  if (mesh.vertices_m.empty()) low = high = Vector3d::Zero();
  center_m_ = (low + high) / 2;
  half_extents_m_ = (high - low) / 2;
  radius_m_ = half_extents_m_.norm();

  const EmbreeGeometryHandle geometry(rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* vertices =
      static_cast<float*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                  3 * sizeof(float), std::max<std::size_t>(1, mesh.vertices_m.size())));
  check_embree();
  for (const Vector3d& vertex : mesh.vertices_m)
    for (int i = 0; i < 3; ++i) *vertices++ = static_cast<float>(vertex[i] - center_m_[i]);
  if (!mesh.triangles.empty())
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                               sizeof mesh.triangles[0], mesh.triangles.size());
  rtcSetGeometryIntersectFilterFunction(geometry.get(), filter_cast);
  rtcSetGeometryOccludedFilterFunction(geometry.get(), filter_blocked);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene_.get(), geometry.get());
  // Robust: no ray slips through between two triangles.
  if (!getenv("NOROBUST")) rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  commit_alone(scene_.get());
}

/// Range to the plane of the triangle, and within what the triangle takes up along the ray: of a triangle seen
/// edge-on the plane alone says little.  -1 when there is none.
double TriangleScene::find_range(const Query& query, int lane, std::uint32_t triangle) const {
  const auto& corners = mesh_.triangles[triangle];
  const Vector3d from = Vector3d::Map(query.from[lane]) + center_m_, direction = Vector3d::Map(query.direction[lane]);
  const Vector3d a = mesh_.vertices_m[corners[0]] - from, b = mesh_.vertices_m[corners[1]] - from,
                 c = mesh_.vertices_m[corners[2]] - from;
  const Vector3d normal = (b - a).cross(c - a);
  const double rate = normal.dot(direction);
  if (rate == 0) return -1;
  const double da = a.dot(direction), db = b.dot(direction), dc = c.dot(direction);
  return std::clamp(normal.dot(a) / rate, std::min({da, db, dc}), std::max({da, db, dc}));
}

void TriangleScene::filter_cast(const RTCFilterFunctionNArguments* arguments) {
  Query& query = *reinterpret_cast<Query*>(arguments->context);
  RayPacket& rays = query.rays;
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    arguments->valid[i] = 0;
    const int lane = static_cast<int>(RTCRayN_id(arguments->ray, n, i));
    const std::uint32_t triangle = RTCHitN_primID(arguments->hit, n, i);
    const double range_m = query.scene.find_range(query, lane, triangle);
    if (!(range_m >= 0)) continue;
    // Of two triangles at one range the lower number counts: an answer must not depend on the order of looking.
    const bool same = range_m == rays.range_m[lane] && rays.part[lane] == query.shape.part;
    if (!(rays.nearer(lane, range_m, query.shape.part) || (same && triangle < rays.triangle[lane]))) continue;
    rays.hit(lane, range_m, query.shape, triangle);
    query.hit |= 1u << lane;
    RTCRayN_tfar(arguments->ray, n, i) = query.floats.limit_m(lane, range_m);
    arguments->valid[i] = -1;
  }
}

void TriangleScene::filter_blocked(const RTCFilterFunctionNArguments* arguments) {
  Query& query = *reinterpret_cast<Query*>(arguments->context);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] == 0) continue;
    const int lane = static_cast<int>(RTCRayN_id(arguments->ray, n, i));
    const double range_m = query.scene.find_range(query, lane, RTCHitN_primID(arguments->hit, n, i));
    const bool blocked = range_m >= 0 && range_m <= query.rays.range_m[lane];
    if (blocked) query.hit |= 1u << lane;
    arguments->valid[i] = blocked ? -1 : 0;
  }
}

unsigned TriangleScene::cast(const RayShape& shape, RayPacket& rays, unsigned lanes) const {
  Query query(*this, shape, rays, lanes);
  query.floats.intersect(scene_.get(), query.context);
  return query.hit;
}

unsigned TriangleScene::find_blocked(const RayShape& shape, RayPacket& rays, unsigned lanes) const {
  Query query(*this, shape, rays, lanes);
  query.floats.find_occluded(scene_.get(), query.context);
  return query.hit;
}

Vector3d TriangleScene::normal(std::uint32_t triangle) const {
  const auto& corners = mesh_.triangles[triangle];
  const Vector3d& a = mesh_.vertices_m[corners[0]];
  return (mesh_.vertices_m[corners[1]] - a).cross(mesh_.vertices_m[corners[2]] - a).normalized();
}

}  // namespace sim
