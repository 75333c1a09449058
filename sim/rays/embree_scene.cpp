// SPDX-License-Identifier: BSD-3-Clause
#include "sim/rays/embree_scene.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sim/base/free_numbers.hpp"
#include "sim/rays/float_rays.hpp"

namespace sim {

// Addition, removal and motion of parts.

void EmbreeScene::add_group(int group) {
  slot(open_, group).clear();
}

void EmbreeScene::add_part(int number, const ScenePart& part) {
  slot(parts_, number) = {part};
  open_[part.group].push_back(number);
}

void EmbreeScene::close_group(int group) {
  for (const int number : open_[group]) add_shape(number);
  open_[group].clear();
}

void EmbreeScene::remove_group(int group, std::span<const int> parts) {
  open_[group].clear();
  for (const int number : parts) {
    if (parts_[number].layer != nullptr) remove_shape(parts_[number]);
    parts_[number] = {};
  }
}

void EmbreeScene::add_shape(int number) {
  Part& added = parts_[number];
  const TriangleScene* triangles = nullptr;
  if (added.part.mesh != nullptr) {
    SharedMesh& shared = meshes_[added.part.mesh];
    if (!shared.triangles) shared.triangles = std::make_unique<TriangleScene>(*added.part.mesh);
    ++shared.users;
    triangles = shared.triangles.get();
  }
  const RayShape shape = make_ray_shape(number, added.part, triangles);
  added.layer = &layer_of(shape, added.part);
  added.at = added.layer->shapes.size();
  added.layer->shapes.push_back(shape);
  added.layer->geoms.push_back(added.part.geom);
  added.layer->changed = true;
}

EmbreeScene::Layer& EmbreeScene::layer_of(const RayShape& shape, const ScenePart& part) {
  if (shape.kind == RayShape::Kind::plane) return planes_;
  if (part.moving) return moving_;
  constexpr std::size_t many = 10'000;
  return part.mesh != nullptr && part.mesh->triangles.size() >= many ? terrain_ : fixed_;
}

/// Removes a shape; the last shape replaces it.
void EmbreeScene::remove_shape(Part& part) {
  Layer& layer = *part.layer;
  parts_[layer.shapes.back().part].at = part.at;
  layer.shapes[part.at] = layer.shapes.back();
  layer.geoms[part.at] = layer.geoms.back();
  layer.shapes.pop_back();
  layer.geoms.pop_back();
  layer.changed = true;
  if (part.part.mesh == nullptr) return;
  const auto shared = meshes_.find(part.part.mesh);
  if (--shared->second.users == 0) meshes_.erase(shared);
}

void EmbreeScene::prepare() const {
  refresh(planes_, moves_.fixed);
  refresh(fixed_, moves_.fixed);
  refresh(terrain_, moves_.fixed);
  refresh(moving_, moves_.moving);
}

void EmbreeScene::refresh(Layer& layer, std::uint64_t moves) const {
  if (layer.seen == moves && !layer.changed) return;
  follow_geoms(layer);
  if (!layer.few()) {
    choose_origin(layer);
    build(layer);
  }
  layer.seen = moves;
  layer.changed = false;
}

void EmbreeScene::follow_geoms(Layer& layer) {
  for (std::size_t i = 0; i < layer.shapes.size(); ++i) {
    RayShape& shape = layer.shapes[i];
    const std::array<double, 3> before = shape.center;
    follow(shape, layer.geoms[i]);
    layer.travelled_m += std::abs(shape.center[0] - before[0]) + std::abs(shape.center[1] - before[1]) +
                         std::abs(shape.center[2] - before[2]);
  }
}

void EmbreeScene::choose_origin(Layer& layer) {
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::max()), high = -low;
  layer.half_width_m = 0;
  double widest_m = 0;
  for (const RayShape& shape : layer.shapes) {
    low = low.cwiseMin(shape.center_W());
    high = high.cwiseMax(shape.center_W());
    const double reach_m = shape.reach_m();
    layer.half_width_m += reach_m;
    widest_m = std::max(widest_m, reach_m);
  }
  layer.origin_W = (low + high) / 2;
  layer.radius_m = (high - low).norm() / 2 + widest_m;
}

/// Builds or refits the tree.  A refit is some ten times faster than a build; but after motions of about the width of
/// the shapes, rays would test too many of them.
void EmbreeScene::build(Layer& layer) {
  // Create the scene.
  if (!layer.scene) {
    layer.scene.reset(rtcNewScene(embree_device()));
    check_embree();
    if (layer.moves) {
      // Embree refits a tree only with both of these settings.
      rtcSetSceneFlags(layer.scene.get(), RTC_SCENE_FLAG_DYNAMIC);
      rtcSetSceneBuildQuality(layer.scene.get(), RTC_BUILD_QUALITY_LOW);
    }
  }
  // Build a new tree after changes or large motions.
  if (!layer.geometry || layer.changed || layer.travelled_m > layer.half_width_m) {
    if (layer.geometry) rtcDetachGeometry(layer.scene.get(), 0);
    layer.geometry.reset(rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_USER));
    check_embree();
    rtcSetGeometryBuildQuality(layer.geometry.get(), RTC_BUILD_QUALITY_REFIT);
    rtcSetGeometryUserPrimitiveCount(layer.geometry.get(), static_cast<unsigned>(layer.shapes.size()));
    rtcSetGeometryUserData(layer.geometry.get(), &layer);
    rtcSetGeometryBoundsFunction(layer.geometry.get(), bounds_of, nullptr);
    rtcSetGeometryIntersectFunction(layer.geometry.get(), intersect);
    rtcSetGeometryOccludedFunction(layer.geometry.get(), find_occluded);
    rtcAttachGeometryByID(layer.scene.get(), layer.geometry.get(), 0);
    layer.travelled_m = 0;
  }
  // Build or refit.
  rtcCommitGeometry(layer.geometry.get());
  commit_alone(layer.scene.get());
}

void EmbreeScene::bounds_of(const RTCBoundsFunctionArguments* arguments) {
  const Layer& layer = *static_cast<const Layer*>(arguments->geometryUserPtr);
  const RayShape& shape = layer.shapes[arguments->primID];
  const double margin_m = FloatRays::rounding * layer.radius_m;
  const Vector3d center = shape.center_W() - layer.origin_W;
  const Vector3d half = shape.half_extents_W() + Vector3d::Constant(margin_m);
  const Eigen::Vector3f low = (center - half).cast<float>(), high = (center + half).cast<float>();
  RTCBounds& out = *arguments->bounds_o;
  out.lower_x = low.x(), out.lower_y = low.y(), out.lower_z = low.z();
  out.upper_x = high.x(), out.upper_y = high.y(), out.upper_z = high.z();
}

// Ray casting.

/// Query of a packet in a layer.  Callbacks get it by its first member.
struct EmbreeScene::Query {
  Query(const Layer& layer, RayPacket& rays_, unsigned lanes, const RayFilter& filter_)
      : rays(rays_), filter(filter_), floats(layer.radius_m) {
    rtcInitIntersectContext(&context);
    if (rays.coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    double from[3][RayPacket::size];
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < RayPacket::size; ++i) from[axis][i] = rays.origin[axis][i] - layer.origin_W[axis];
    floats.aim(from, rays.direction, rays.range_m, lanes);
  }

  RTCIntersectContext context;
  RayPacket& rays;
  const RayFilter& filter;
  unsigned blocked = 0;  // lanes
  FloatRays floats;
};

/// Records nearer hits on the shape; returns the lanes that have one.
unsigned EmbreeScene::cast_at(const RayShape& shape, RayPacket& rays, unsigned lanes) {
  if (shape.kind == RayShape::Kind::mesh) return shape.mesh->cast(shape, rays, lanes);
  alignas(64) double range_m[RayPacket::size];
  find_ranges(shape, rays, lanes, range_m);
  unsigned hit = 0;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    if (!rays.nearer(lane, range_m[lane], shape.part)) continue;
    rays.hit(lane, range_m[lane], shape);
    hit |= 1u << lane;
  }
  return hit;
}

unsigned EmbreeScene::blocked_by(const RayShape& shape, RayPacket& rays, unsigned lanes) {
  if (shape.kind == RayShape::Kind::mesh) return shape.mesh->find_blocked(shape, rays, lanes);
  alignas(64) double range_m[RayPacket::size];
  find_ranges(shape, rays, lanes, range_m);
  unsigned blocked = 0;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    if (range_m[lane] <= rays.range_m[lane]) blocked |= 1u << lane;
  }
  return blocked;
}

namespace {

/// Returns the active lanes of a callback.
unsigned lanes_of(const int* valid, RTCRayN* rays, unsigned count) {
  unsigned lanes = 0;
  for (unsigned i = 0; i < count; ++i)
    if (valid[i] != 0) lanes |= 1u << RTCRayN_id(rays, count, i);
  return lanes;
}

}  // namespace

void EmbreeScene::intersect(const RTCIntersectFunctionNArguments* arguments) {
  Query& query = *reinterpret_cast<Query*>(arguments->context);
  const RayShape& shape = static_cast<const Layer*>(arguments->geometryUserPtr)->shapes[arguments->primID];
  if (!shape.stops(query.filter)) return;
  const unsigned n = arguments->N;
  RTCRayN* rays = RTCRayHitN_RayN(arguments->rayhit, n);
  const unsigned hit = cast_at(shape, query.rays, lanes_of(arguments->valid, rays, n));
  if (hit == 0) return;
  for (unsigned i = 0; i < n; ++i) {
    const int lane = static_cast<int>(RTCRayN_id(rays, n, i));
    if (arguments->valid[i] != 0 && (hit >> lane & 1) != 0)
      RTCRayN_tfar(rays, n, i) = query.floats.limit_m(lane, query.rays.range_m[lane]);
  }
}

void EmbreeScene::find_occluded(const RTCOccludedFunctionNArguments* arguments) {
  Query& query = *reinterpret_cast<Query*>(arguments->context);
  const RayShape& shape = static_cast<const Layer*>(arguments->geometryUserPtr)->shapes[arguments->primID];
  if (!shape.stops(query.filter)) return;
  const unsigned n = arguments->N;
  const unsigned blocked = blocked_by(shape, query.rays, lanes_of(arguments->valid, arguments->ray, n));
  query.blocked |= blocked;
  for (unsigned i = 0; i < n; ++i)
    if (arguments->valid[i] != 0 && (blocked >> RTCRayN_id(arguments->ray, n, i) & 1) != 0)
      RTCRayN_tfar(arguments->ray, n, i) = -std::numeric_limits<float>::infinity();
}

void EmbreeScene::cast_packet(RayPacket& rays, unsigned lanes, const RayFilter& filter) const {
  for (const Layer* layer : in_order()) {
    if (layer->few()) {
      for (const RayShape& shape : layer->shapes)
        if (shape.stops(filter)) cast_at(shape, rays, lanes);
      continue;
    }
    Query query(*layer, rays, lanes, filter);
    query.floats.intersect(layer->scene.get(), query.context);
  }
}

unsigned EmbreeScene::blocked_packet(RayPacket& rays, unsigned lanes, const RayFilter& filter) const {
  unsigned blocked = 0;
  for (const Layer* layer : in_order()) {
    if (layer->few()) {
      for (const RayShape& shape : layer->shapes)
        if (shape.stops(filter)) blocked |= blocked_by(shape, rays, lanes & ~blocked);
      continue;
    }
    if ((lanes & ~blocked) == 0) break;
    Query query(*layer, rays, lanes & ~blocked, filter);
    query.floats.find_occluded(layer->scene.get(), query.context);
    blocked |= query.blocked;
  }
  return blocked;
}

RayHit EmbreeScene::hit_of(const RayPacket& rays, int lane) const {
  if (rays.part[lane] == RayPacket::no_part) return {};
  const RayShape& shape = *rays.shape[lane];
  RayHit hit{rays.range_m[lane], Vector3d::Zero(), shape.part, shape.material};
  const Vector3d direction_W = rays.direction_W(lane);
  if (shape.mesh != nullptr) {
    const Vector3d normal = shape.mesh->normal(rays.triangle[lane]);
    hit.normal_W = normal.x() * shape.axis_W(0) + normal.y() * shape.axis_W(1) + normal.z() * shape.axis_W(2);
    const std::span<const int> materials = parts_[static_cast<std::size_t>(shape.part)].part.triangle_materials;
    if (!materials.empty()) hit.material = materials[rays.triangle[lane]];
  } else {
    hit.normal_W = normal_at(shape, rays.origin_W(lane) + hit.range_m * direction_W);
  }
  if (hit.normal_W.dot(direction_W) > 0) hit.normal_W = -hit.normal_W;
  return hit;
}

std::optional<RayHit> EmbreeScene::cast(const Vector3d& origin_W, const Vector3d& direction_W, double range_max_m,
                                        const RayFilter& filter) const {
  if (!(range_max_m > 0)) return std::nullopt;
  prepare();
  RayPacket rays;
  rays.set(0, origin_W, direction_W, range_max_m);
  for (int lane = 1; lane < RayPacket::size; ++lane) rays.repeat(0, lane);
  cast_packet(rays, 1, filter);
  if (rays.part[0] == RayPacket::no_part) return std::nullopt;
  return hit_of(rays, 0);
}

namespace {

/// Calls use(first, rays, lanes) for packets of the rays that set(lane, number) gives.  Rays of zero length are
/// skipped.
template <typename Set, typename Use>
void for_packets(std::size_t count, bool coherent, Set&& set, Use&& use) {
  RayPacket rays;
  rays.coherent = coherent;
  for (std::size_t first = 0; first < count; first += RayPacket::size) {
    const int used = static_cast<int>(std::min<std::size_t>(RayPacket::size, count - first));
    unsigned lanes = 0;
    for (int lane = 0; lane < used; ++lane) {
      set(rays, lane, first + static_cast<std::size_t>(lane));
      if (rays.range_m[lane] > 0) lanes |= 1u << lane;
    }
    for (int lane = used; lane < RayPacket::size; ++lane) rays.repeat(0, lane);
    use(first, rays, lanes);
  }
}

/// Cache of sines and cosines of the last fan of this thread, as a fleet has many equal sensors.
struct FanDirections {
  double first_angle_rad = 0, step_rad = 0;
  std::vector<std::array<double, 2>> cos_sin;

  void update(const Fan& fan) {
    const auto count = static_cast<std::size_t>(fan.count);
    if (fan.first_angle_rad == first_angle_rad && fan.step_rad == step_rad && cos_sin.size() >= count) return;
    first_angle_rad = fan.first_angle_rad;
    step_rad = fan.step_rad;
    cos_sin.clear();
    for (int i = 0; i < fan.count; ++i) {
      const double angle_rad = first_angle_rad + i * step_rad;
      cos_sin.push_back({std::cos(angle_rad), std::sin(angle_rad)});
    }
  }
};

}  // namespace

void EmbreeScene::cast_fan(const Fan& fan, const RayFilter& filter, std::span<RayHit> hits) const {
  if (fan.count <= 0) return;
  prepare();
  thread_local FanDirections directions;
  directions.update(fan);
  const Matrix3d R_WS = fan.X_WS.linear();
  const Vector3d p_WS = fan.X_WS.translation();
  // With larger angles between rays (2.5 degrees) single rays are faster than packets.
  constexpr double together_rad = 0.044;
  for_packets(
      static_cast<std::size_t>(fan.count), std::abs(fan.step_rad) < together_rad,
      [&](RayPacket& rays, int lane, std::size_t i) {
        const auto [c, s] = directions.cos_sin[i];
        rays.set(lane, p_WS, R_WS.col(0) * c + R_WS.col(1) * s, fan.range_max_m);
      },
      [&](std::size_t first, RayPacket& rays, unsigned lanes) {
        cast_packet(rays, lanes, filter);
        for (std::size_t i = first; i < std::min(first + RayPacket::size, hits.size()); ++i)
          hits[i] = hit_of(rays, static_cast<int>(i - first));
      });
}

void EmbreeScene::cast(std::span<const Ray> rays_, const RayFilter& filter, std::span<RayHit> hits) const {
  prepare();
  for_packets(
      rays_.size(), true,
      [&](RayPacket& rays, int lane, std::size_t i) {
        rays.set(lane, rays_[i].origin_W, rays_[i].direction_W, rays_[i].range_max_m);
      },
      [&](std::size_t first, RayPacket& rays, unsigned lanes) {
        cast_packet(rays, lanes, filter);
        for (std::size_t i = first; i < std::min(first + RayPacket::size, hits.size()); ++i)
          hits[i] = hit_of(rays, static_cast<int>(i - first));
      });
}

void EmbreeScene::find_blocked(std::span<const Ray> rays_, const RayFilter& filter,
                               std::span<std::uint8_t> blocked) const {
  prepare();
  for_packets(
      rays_.size(), true,
      [&](RayPacket& rays, int lane, std::size_t i) {
        rays.set(lane, rays_[i].origin_W, rays_[i].direction_W, rays_[i].range_max_m);
      },
      [&](std::size_t first, RayPacket& rays, unsigned lanes) {
        const unsigned found = blocked_packet(rays, lanes, filter);
        for (std::size_t i = first; i < std::min(first + RayPacket::size, blocked.size()); ++i)
          blocked[i] = found >> (i - first) & 1;
      });
}

}  // namespace sim
