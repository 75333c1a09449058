// SPDX-License-Identifier: BSD-3-Clause
// Ray casting of EmbreeScene.
#include <algorithm>
#include <bit>
#include <cmath>

#include "sim/rays/embree_scene.hpp"
#include "sim/rays/float_rays.hpp"
#include "sim/rays/ray_bundle.hpp"

namespace sim {

/// Query of a packet in a layer.  Callbacks get it by its first member.
struct EmbreeScene::Query {
  Query(const Layer& layer, RayPacket& rays_, unsigned lanes, const RayFilter& filter_)
      : embree(rays_.coherent), rays(rays_), filter(filter_), floats(layer.radius_m) {
    double from[3][RayPacket::size];
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < RayPacket::size; ++i) from[axis][i] = rays.origin[axis][i] - layer.origin_W[axis];
    floats.aim(from, rays.direction, rays.range_m, lanes);
  }

  RayQuery embree;  // first: see RayQuery
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
  // Most candidates are missed by far.
  constexpr unsigned all = (1u << RayPacket::size) - 1;
  if (n == 1 && passes_by(shape, query.rays, static_cast<int>(RTCRayN_id(rays, 1, 0)))) return;
  const unsigned near = n == 1 ? all : near_lanes(shape, query.rays, all);
  if (near == 0) return;
  const unsigned lanes = near & lanes_of(arguments->valid, rays, n);
  if (lanes == 0) return;
  const unsigned hit = cast_at(shape, query.rays, lanes);
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

/// Targets of the rays of a bundle: single shapes, and layers to search by their trees.
struct EmbreeScene::Targets {
  Targets(const EmbreeScene& scene, const RayFilter& filter_, const RayBundle& bundle)
      : filter(filter_), planes(scene.planes_.shapes) {
    for (const Layer* layer : {&scene.moving_, &scene.fixed_, &scene.terrain_}) {
      constexpr std::size_t max_tested = 64;
      const bool test = layer->shapes.size() <= (bundle.is_narrow() ? max_tested : std::size_t{max_few});
      const auto stops = [&](const RayShape& shape) { return shape.stops(filter) && bundle.may_reach(shape); };
      if (!test || !add_shapes(layer->shapes, stops)) add_tree(*layer, bundle);
    }
  }
  /// Targets of a bundle of a fan, which were found before.
  Targets(const FanTargets& fan, const RayBundle& bundle);

  RayFilter filter;
  std::span<const RayShape> planes;
  std::array<const RayShape*, 3 * max_few> shapes;
  int shape_count = 0;
  /// Layers in order of the cost of intersections: terrain is last, and is cheaper for rays that other hits have
  /// shortened.
  std::array<const Layer*, 3> trees;
  int tree_count = 0;

  template <typename Use>
  void for_each_shape(Use&& use) const {
    for (const RayShape& shape : planes)
      if (shape.stops(filter)) use(shape);
    for (int i = 0; i < shape_count; ++i) use(*shapes[i]);
  }

 private:
  static const RayShape& shape_of(const RayShape& shape) { return shape; }
  static const RayShape& shape_of(const RayShape* shape) { return *shape; }
  /// Adds the shapes of the layer that count; returns false when they are so many that its tree is faster.
  template <typename Shapes, typename Counts>
  bool add_shapes(const Shapes& layer, const Counts& counts) {
    const int before = shape_count;
    for (const auto& each : layer) {
      const RayShape& shape = shape_of(each);
      if (!counts(shape)) continue;
      if (shape_count - before == max_few) {
        shape_count = before;
        return false;
      }
      shapes[shape_count++] = &shape;
    }
    return true;
  }
  void add_tree(const Layer& layer, const RayBundle& bundle) {
    if (bundle.may_reach(layer.origin_W, layer.radius_m)) trees[tree_count++] = &layer;
  }
};

/// Targets of the rays of a fan: shapes at its height and within its range.
struct EmbreeScene::FanTargets {
  FanTargets(const EmbreeScene& scene, const RayFilter& filter_, const Fan& fan)
      : filter(filter_), planes(scene.planes_.shapes), layers{&scene.moving_, &scene.fixed_, &scene.terrain_} {
    const Vector3d from_W = fan.X_WS.translation(), up_W = fan.X_WS.linear().col(2);
    for (std::size_t i = 0; i < layers.size(); ++i) {
      constexpr std::size_t max_tested = 256;
      // Testing every shape pays for few shapes only; a layer with more uses its tree.
      listed[i] = layers[i]->shapes.size() <= max_tested;
      if (!listed[i]) continue;
      for (const RayShape& shape : layers[i]->shapes) {
        if (!shape.stops(filter)) continue;
        const Vector3d to_W = shape.center_W() - from_W;
        const double reach_m = std::sqrt(shape.misses_beyond_m2), far_m = fan.range_max_m + reach_m;
        // The shape must cross the plane of the fan, within range.
        if (std::abs(to_W.dot(up_W)) > reach_m || to_W.squaredNorm() > far_m * far_m) continue;
        listed[i] = counts[i] < max_listed;
        if (!listed[i]) break;
        shapes[i][counts[i]++] = &shape;
      }
    }
  }
  std::span<const RayShape* const> shapes_of(std::size_t layer) const {
    return std::span(shapes[layer]).first(counts[layer]);
  }

  RayFilter filter;
  std::span<const RayShape> planes;
  std::array<const Layer*, 3> layers;
  static constexpr std::size_t max_listed = 48;
  std::array<bool, 3> listed;  // by layer: all that count are in `shapes`
  std::array<std::size_t, 3> counts{};
  std::array<std::array<const RayShape*, max_listed>, 3> shapes;
};

EmbreeScene::Targets::Targets(const FanTargets& fan, const RayBundle& bundle) : filter(fan.filter), planes(fan.planes) {
  const auto counts = [&](const RayShape& shape) { return bundle.may_reach(shape); };
  for (std::size_t i = 0; i < fan.layers.size(); ++i)
    if (!fan.listed[i] || !add_shapes(fan.shapes_of(i), counts)) add_tree(*fan.layers[i], bundle);
}

void EmbreeScene::cast_packet(RayPacket& rays, unsigned lanes, const Targets& targets) {
  targets.for_each_shape([&](const RayShape& shape) { cast_at(shape, rays, lanes); });
  for (int i = 0; i < targets.tree_count; ++i) {
    Query query(*targets.trees[i], rays, lanes, targets.filter);
    query.floats.intersect(targets.trees[i]->scene.get(), query.embree);
  }
}

unsigned EmbreeScene::blocked_packet(RayPacket& rays, unsigned lanes, const Targets& targets) {
  unsigned blocked = 0;
  targets.for_each_shape([&](const RayShape& shape) {
    // Rays that are blocked already need no further test.
    if ((lanes & ~blocked) != 0) blocked |= blocked_by(shape, rays, lanes & ~blocked);
  });
  for (int i = 0; i < targets.tree_count && (lanes & ~blocked) != 0; ++i) {
    Query query(*targets.trees[i], rays, lanes & ~blocked, targets.filter);
    query.floats.find_occluded(targets.trees[i]->scene.get(), query.embree);
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
  } else if (shape.kind == RayShape::Kind::plane) {
    hit.normal_W = shape.axis_W(2);
  } else {
    hit.normal_W = normal_at(shape, rays.origin_W(lane) + hit.range_m * direction_W);
  }
  // Back faces are seen, too, from inside of a shape: the normal always points to the sensor.
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
  cast_packet(rays, 1, Targets(*this, filter, RayBundle()));
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

/// Calls use(start, rays) for groups of neighboring rays.
template <typename Use>
void for_bundles(std::span<const Ray> rays, Use&& use) {
  constexpr std::size_t together = 64;
  for (std::size_t start = 0; start < rays.size(); start += together)
    use(start, rays.subspan(start, std::min(together, rays.size() - start)));
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
  const FanTargets of_fan(*this, filter, fan);
  // Bundles of packets, whose rays differ little in direction.
  constexpr std::size_t packets_together = 2;
  constexpr std::size_t together = packets_together * RayPacket::size;
  const auto count = std::min(static_cast<std::size_t>(fan.count), hits.size());
  const bool coherent = std::abs(fan.step_rad) < together_rad;
  for (std::size_t start = 0; start < count; start += together) {
    const std::size_t in_bundle = std::min(together, count - start);
    const auto direction_W = [&](std::size_t i) -> Vector3d {
      const auto [c, s] = directions.cos_sin[start + i];
      return R_WS.col(0) * c + R_WS.col(1) * s;
    };
    const Ray ends[] = {{p_WS, direction_W(0), fan.range_max_m},
                        {p_WS, direction_W(in_bundle / 2), fan.range_max_m},
                        {p_WS, direction_W(in_bundle - 1), fan.range_max_m}};
    const Targets targets(of_fan, coherent ? RayBundle(ends) : RayBundle());
    for_packets(
        in_bundle, coherent,
        [&](RayPacket& rays, int lane, std::size_t i) { rays.set(lane, p_WS, direction_W(i), fan.range_max_m); },
        [&](std::size_t first, RayPacket& rays, unsigned lanes) {
          cast_packet(rays, lanes, targets);
          for (std::size_t i = first; i < std::min(first + RayPacket::size, in_bundle); ++i)
            hits[start + i] = hit_of(rays, static_cast<int>(i - first));
        });
  }
}

void EmbreeScene::cast(std::span<const Ray> rays_, const RayFilter& filter, std::span<RayHit> hits) const {
  prepare();
  for_bundles(rays_, [&](std::size_t start, std::span<const Ray> bundle) {
    const Targets targets(*this, filter, RayBundle(bundle));
    const std::span<RayHit> found = hits.subspan(start, bundle.size());
    for_packets(
        bundle.size(), true,
        [&](RayPacket& rays, int lane, std::size_t i) {
          rays.set(lane, bundle[i].origin_W, bundle[i].direction_W, bundle[i].range_max_m);
        },
        [&](std::size_t first, RayPacket& rays, unsigned lanes) {
          cast_packet(rays, lanes, targets);
          for (std::size_t i = first; i < std::min(first + RayPacket::size, found.size()); ++i)
            found[i] = hit_of(rays, static_cast<int>(i - first));
        });
  });
}

void EmbreeScene::find_blocked(std::span<const Ray> rays_, const RayFilter& filter,
                               std::span<std::uint8_t> blocked) const {
  prepare();
  for_bundles(rays_, [&](std::size_t start, std::span<const Ray> bundle) {
    const Targets targets(*this, filter, RayBundle(bundle));
    const std::span<std::uint8_t> found = blocked.subspan(start, bundle.size());
    for_packets(
        bundle.size(), true,
        [&](RayPacket& rays, int lane, std::size_t i) {
          rays.set(lane, bundle[i].origin_W, bundle[i].direction_W, bundle[i].range_max_m);
        },
        [&](std::size_t first, RayPacket& rays, unsigned lanes) {
          const unsigned lanes_blocked = blocked_packet(rays, lanes, targets);
          for (std::size_t i = first; i < std::min(first + RayPacket::size, found.size()); ++i)
            found[i] = lanes_blocked >> (i - first) & 1;
        });
  });
}

}  // namespace sim
