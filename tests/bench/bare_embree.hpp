// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sim/geometry/mesh.hpp"
#include "sim/rays/embree_library.hpp"

/// What Embree alone does, used in the plain way: single precision throughout, one scene, no filters.
namespace bare_embree {

struct Shape {
  int kind;  // class of the geom
  std::array<float, 3> size;
  std::array<float, 3> center;
  std::array<float, 9> axes;
};

struct Vec {
  float x, y, z;
};
inline Vec operator+(Vec a, Vec b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec operator*(float s, Vec a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline float dot(Vec a, Vec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline Shape shape_of(dGeomID geom) {
  Shape shape{dGeomGetClass(geom), {}, {}, {}};
  dVector3 lengths;
  dReal radius = 0, length = 0;
  if (shape.kind == dBoxClass) {
    dGeomBoxGetLengths(geom, lengths);
    for (int i = 0; i < 3; ++i) shape.size[i] = static_cast<float>(lengths[i] / 2);
    return shape;
  }
  if (shape.kind == dSphereClass) radius = dGeomSphereGetRadius(geom);
  if (shape.kind == dCapsuleClass) dGeomCapsuleGetParams(geom, &radius, &length);
  if (shape.kind == dCylinderClass) dGeomCylinderGetParams(geom, &radius, &length);
  shape.size = {static_cast<float>(radius), static_cast<float>(length / 2), 0};
  return shape;
}

inline void follow(Shape& shape, dGeomID geom) {
  const dReal* p = dGeomGetPosition(geom);
  const dReal* R = dGeomGetRotation(geom);
  for (int i = 0; i < 3; ++i) {
    shape.center[i] = static_cast<float>(p[i]);
    for (int axis = 0; axis < 3; ++axis) shape.axes[3 * axis + i] = static_cast<float>(R[4 * i + axis]);
  }
}

inline void bounds(const RTCBoundsFunctionArguments* a) {
  const Shape& s = (*static_cast<const std::vector<Shape>*>(a->geometryUserPtr))[a->primID];
  float half[3];
  for (int i = 0; i < 3; ++i) {
    const float x = std::abs(s.axes[i]), y = std::abs(s.axes[3 + i]), z = std::abs(s.axes[6 + i]);
    if (s.kind == dBoxClass) half[i] = x * s.size[0] + y * s.size[1] + z * s.size[2];
    if (s.kind == dSphereClass) half[i] = s.size[0];
    if (s.kind == dCapsuleClass) half[i] = z * s.size[1] + s.size[0];
    if (s.kind == dCylinderClass) half[i] = z * s.size[1] + s.size[0] * std::sqrt(std::max(0.0f, 1 - z * z));
  }
  *a->bounds_o = {s.center[0] - half[0], s.center[1] - half[1], s.center[2] - half[2], 0,
                  s.center[0] + half[0], s.center[1] + half[1], s.center[2] + half[2], 0};
}

/// Range and normal (in the frame of the shape) of the first hit in front of the origin.
inline bool meet(const Shape& s, Vec o, Vec d, float& range, Vec& normal) {
  const float r = s.size[0];
  if (s.kind == dBoxClass) {
    const float from[3] = {o.x, o.y, o.z}, along[3] = {d.x, d.y, d.z};
    float enter = -INFINITY, leave = INFINITY;
    int axis = 0;
    for (int i = 0; i < 3; ++i) {
      const float inverse = 1 / along[i];
      const float a = (-s.size[i] - from[i]) * inverse, b = (s.size[i] - from[i]) * inverse;
      if (std::min(a, b) > enter) enter = std::min(a, b), axis = i;
      leave = std::min(leave, std::max(a, b));
    }
    if (enter > leave || leave < 0) return false;
    range = enter >= 0 ? enter : leave;
    normal = {axis == 0 ? -std::copysign(1.0f, d.x) : 0.0f, axis == 1 ? -std::copysign(1.0f, d.y) : 0.0f,
              axis == 2 ? -std::copysign(1.0f, d.z) : 0.0f};
    return true;
  }
  const auto sphere = [&](float z) {
    const Vec c{o.x, o.y, o.z - z};
    const float b = dot(c, d), rest = r * r - dot(c, c) + b * b;
    if (rest < 0) return false;
    range = -b - std::sqrt(rest);
    if (range < 0) range = -b + std::sqrt(rest);
    normal = (1 / r) * (c + range * d);
    return range >= 0;
  };
  if (s.kind == dSphereClass) return sphere(0);
  const float h = s.size[1];
  const float a = d.x * d.x + d.y * d.y, b = o.x * d.x + o.y * d.y, c = o.x * o.x + o.y * o.y - r * r;
  const float rest = b * b - a * c;
  if (rest < 0) return false;
  const float side = (-b - std::sqrt(rest)) / a, z = o.z + side * d.z;
  if (side >= 0 && std::abs(z) <= h) {
    range = side;
    normal = {(o.x + side * d.x) / r, (o.y + side * d.y) / r, 0};
    return true;
  }
  if (s.kind == dCapsuleClass) return sphere(z > 0 ? h : -h);
  const float end = d.z > 0 ? -h : h;
  range = (end - o.z) / d.z;
  const float x = o.x + range * d.x, y = o.y + range * d.y;
  normal = {0, 0, end > 0 ? 1.0f : -1.0f};
  return range >= 0 && x * x + y * y <= r * r;
}

inline void local_ray(const Shape& s, RTCRayN* rays, unsigned n, unsigned i, Vec& o, Vec& d) {
  const Vec p{RTCRayN_org_x(rays, n, i) - s.center[0], RTCRayN_org_y(rays, n, i) - s.center[1],
              RTCRayN_org_z(rays, n, i) - s.center[2]};
  const Vec v{RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)};
  const Vec x{s.axes[0], s.axes[1], s.axes[2]}, y{s.axes[3], s.axes[4], s.axes[5]}, z{s.axes[6], s.axes[7], s.axes[8]};
  o = {dot(x, p), dot(y, p), dot(z, p)};
  d = {dot(x, v), dot(y, v), dot(z, v)};
}

inline void intersect(const RTCIntersectFunctionNArguments* a) {
  const Shape& s = (*static_cast<const std::vector<Shape>*>(a->geometryUserPtr))[a->primID];
  RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
  RTCHitN* hits = RTCRayHitN_HitN(a->rayhit, a->N);
  for (unsigned i = 0; i < a->N; ++i) {
    if (a->valid[i] == 0) continue;
    Vec o, d, normal;
    float range;
    local_ray(s, rays, a->N, i, o, d);
    if (!meet(s, o, d, range, normal) || range > RTCRayN_tfar(rays, a->N, i)) continue;
    RTCRayN_tfar(rays, a->N, i) = range;
    const Vec x{s.axes[0], s.axes[1], s.axes[2]}, y{s.axes[3], s.axes[4], s.axes[5]},
        z{s.axes[6], s.axes[7], s.axes[8]};
    const Vec n_W = normal.x * x + normal.y * y + normal.z * z;
    RTCHitN_Ng_x(hits, a->N, i) = n_W.x;
    RTCHitN_Ng_y(hits, a->N, i) = n_W.y;
    RTCHitN_Ng_z(hits, a->N, i) = n_W.z;
    RTCHitN_primID(hits, a->N, i) = a->primID;
    RTCHitN_geomID(hits, a->N, i) = a->geomID;
  }
}

inline void occluded(const RTCOccludedFunctionNArguments* a) {
  const Shape& s = (*static_cast<const std::vector<Shape>*>(a->geometryUserPtr))[a->primID];
  for (unsigned i = 0; i < a->N; ++i) {
    if (a->valid[i] == 0) continue;
    Vec o, d, normal;
    float range;
    local_ray(s, a->ray, a->N, i, o, d);
    if (meet(s, o, d, range, normal) && range <= RTCRayN_tfar(a->ray, a->N, i))
      RTCRayN_tfar(a->ray, a->N, i) = -INFINITY;
  }
}

class Scene {
 public:
  Scene(const std::vector<dGeomID>& geoms, const sim::Mesh* terrain) : geoms_(geoms) {
    for (const dGeomID geom : geoms) shapes_.push_back(shape_of(geom));
    if (terrain) add_terrain(*terrain);
    user_ = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(user_, static_cast<unsigned>(shapes_.size()));
    rtcSetGeometryUserData(user_, &shapes_);
    rtcSetGeometryBoundsFunction(user_, bounds, nullptr);
    rtcSetGeometryIntersectFunction(user_, intersect);
    rtcSetGeometryOccludedFunction(user_, occluded);
    rtcAttachGeometry(scene_, user_);
    // As our moving parts have it: only all three together make Embree refit its tree.
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryBuildQuality(user_, RTC_BUILD_QUALITY_REFIT);
    update();
  }
  ~Scene() {
    rtcReleaseGeometry(user_);
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  void update() {
    for (std::size_t i = 0; i < shapes_.size(); ++i) follow(shapes_[i], geoms_[i]);
    rtcCommitGeometry(user_);
    rtcCommitScene(scene_);
  }
  RTCScene get() const { return scene_; }

 private:
  void add_terrain(const sim::Mesh& mesh) {
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.vertices_m.size()));
    for (const auto& vertex : mesh.vertices_m)
      for (int i = 0; i < 3; ++i) *vertices++ = static_cast<float>(vertex[i]);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0, 12,
                               mesh.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
  }

  std::vector<dGeomID> geoms_;
  std::vector<Shape> shapes_;
  RTCDevice device_ = rtcNewDevice("isa=avx2,threads=1");
  RTCScene scene_ = rtcNewScene(device_);
  RTCGeometry user_;
};

}  // namespace bare_embree
