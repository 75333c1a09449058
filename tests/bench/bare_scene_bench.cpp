// SPDX-License-Identifier: BSD-3-Clause
// Our rays against bare Embree's in one scene: parts of all shapes strewn over 100 m x 100 m of terrain of 512 x 512
// cells.  Lidars: 200 of 180 beams of 20 m; ns per ray.  Camera: 320 x 240 pixels, ms per frame.  Update: every part
// has moved; ms.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "sim/ode/ode_library.hpp"
#include "sim/ode/ode_math.hpp"
#include "sim/rays/world_scene.hpp"
#include "tests/bench/bare_embree.hpp"

namespace {

using sim::Ray;
using sim::RayHit;
using sim::Vector3d;

using std::numbers::pi;
constexpr int lidars = 200, beams = 180;
constexpr double range_m = 20;
constexpr int columns = 320, rows = 240, tile = 8;
constexpr float camera_range_m = 200;

double height_m(double x, double y) {
  return 2 * std::sin(0.1 * x) * std::cos(0.07 * y) + 0.1 * std::sin(1.7 * x + 0.9 * y);
}

/// Two triangles a cell.
sim::Mesh make_terrain() {
  constexpr std::uint32_t cells = 512;
  sim::Mesh mesh;
  for (std::uint32_t row = 0; row <= cells; ++row)
    for (std::uint32_t column = 0; column <= cells; ++column) {
      const double x = 100.0 * column / cells, y = 100.0 * row / cells;
      mesh.vertices_m.emplace_back(x, y, height_m(x, y));
    }
  for (std::uint32_t row = 0; row < cells; ++row)
    for (std::uint32_t column = 0; column < cells; ++column) {
      const std::uint32_t a = row * (cells + 1) + column, b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

/// The same parts in our scene and in a bare one.
struct Strewn {
  explicit Strewn(int count, bool with_terrain = true) {
    sim::start_ode();
    if (with_terrain) terrain = make_terrain();
    scene = sim::make_world_scene(sim::RayLibrary::embree, moves);
    scene->add_group(0);
    if (with_terrain) {
      ground.reset(dCreateBox(nullptr, 1, 1, 1));  // only its pose counts
      scene->add_part(count, {ground.get(), 0, 1, 0, 0, false, &terrain, {}});
    }
    for (int i = 0; i < count; ++i) {
      const double a = uniform(0.3, 1.5), b = uniform(0.3, 1.5), r = uniform(0.2, 0.5);
      geoms.emplace_back(i % 4 == 0   ? dCreateBox(nullptr, a, b, 2)
                         : i % 4 == 1 ? dCreateSphere(nullptr, r)
                         : i % 4 == 2 ? dCreateCapsule(nullptr, r, a)
                                      : dCreateCylinder(nullptr, r, b));
      bare_geoms.push_back(geoms.back().get());
      const double x = uniform(0, 100), y = uniform(0, 100);
      put(i, {x, y, height_m(x, y) + 0.5}, {uniform(-0.5, 0.5), uniform(-0.5, 0.5), uniform(-3, 3)});
      scene->add_part(i, {bare_geoms.back(), 0, 1, 0, 0, true, nullptr, {}});
    }
    scene->close_group(0);
    scene->prepare();
    bare = std::make_unique<bare_embree::Scene>(bare_geoms, with_terrain ? &terrain : nullptr);
  }
  double uniform(double low, double high) { return low + (high - low) * (random() / 4294967296.0); }
  void put(int i, const Vector3d& p, const Vector3d& rpy) {
    dMatrix3 R;
    sim::to_ode(sim::rotation_from_rpy(rpy), R);
    dGeomSetPosition(geoms[i].get(), p.x(), p.y(), p.z());
    dGeomSetRotation(geoms[i].get(), R);
  }
  void move_all() {
    for (const dGeomID geom : bare_geoms) {
      const dReal* p = dGeomGetPosition(geom);
      dGeomSetPosition(geom, p[0] + uniform(-0.01, 0.01), p[1] + uniform(-0.01, 0.01), p[2]);
    }
    ++moves.moving;
  }

  std::mt19937 random{1};
  sim::Mesh terrain;
  sim::SceneMoves moves;
  sim::GeomHandle ground;
  std::vector<sim::GeomHandle> geoms;
  std::vector<dGeomID> bare_geoms;
  std::unique_ptr<sim::WorldScene> scene;
  std::unique_ptr<bare_embree::Scene> bare;
};

/// Kept: the terrain takes a second to make.
Strewn& strewn(int count) {
  static std::map<int, std::unique_ptr<Strewn>> all;
  auto& one = all[count];
  if (!one) one = std::make_unique<Strewn>(count);
  return *one;
}

std::vector<sim::Fan> make_fans() {
  std::mt19937 random(2);
  std::vector<sim::Fan> fans;
  for (int i = 0; i < lidars; ++i) {
    const double x = random() % 100 + 0.5, y = random() % 100 + 0.5;
    fans.push_back({sim::make_pose({x, y, height_m(x, y) + 0.7}, {0, 0, 0.01 * (random() % 628)}), -pi / 2,
                    pi / (beams - 1), beams, range_m});
  }
  return fans;
}

void per_ray(benchmark::State& state) {
  state.counters["ray"] = benchmark::Counter(static_cast<double>(state.iterations()) * beams,
                                             benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void lidars_ours(benchmark::State& state) {
  const Strewn& all = strewn(static_cast<int>(state.range(0)));
  const std::vector<sim::Fan> fans = make_fans();
  std::vector<RayHit> hits(beams);
  std::size_t next = 0;
  for (auto _ : state) {
    all.scene->cast_fan(fans[next++ % fans.size()], {}, hits);
    benchmark::DoNotOptimize(hits.data());
  }
  per_ray(state);
}

/// Directions are computed ahead, as ours keeps them.
struct BareFan {
  float origin[3];
  std::vector<std::array<float, 3>> directions;
};
std::vector<BareFan> make_bare_fans() {
  std::vector<BareFan> all;
  for (const sim::Fan& fan : make_fans()) {
    const Vector3d p = fan.X_WS.translation();
    BareFan bare{{static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())}, {}};
    for (int i = 0; i < fan.count; ++i) {
      const double angle = fan.first_angle_rad + i * fan.step_rad;
      const Eigen::Vector3f d = (fan.X_WS.linear() * Vector3d(std::cos(angle), std::sin(angle), 0)).cast<float>();
      bare.directions.push_back({d.x(), d.y(), d.z()});
    }
    all.push_back(std::move(bare));
  }
  return all;
}

struct BareHit {
  float range, normal[3];
  unsigned part;
};

template <typename RayHit>
void aim(RayHit& ray, unsigned n, unsigned i, const float* origin, const float* direction, float range) {
  auto* rays = reinterpret_cast<RTCRayN*>(&ray.ray);
  RTCRayN_org_x(rays, n, i) = origin[0];
  RTCRayN_org_y(rays, n, i) = origin[1];
  RTCRayN_org_z(rays, n, i) = origin[2];
  RTCRayN_dir_x(rays, n, i) = direction[0];
  RTCRayN_dir_y(rays, n, i) = direction[1];
  RTCRayN_dir_z(rays, n, i) = direction[2];
  RTCRayN_tnear(rays, n, i) = RTCRayN_time(rays, n, i) = 0;
  RTCRayN_tfar(rays, n, i) = range;
  RTCRayN_mask(rays, n, i) = ~0u;
  RTCRayN_flags(rays, n, i) = 0;
  RTCHitN_geomID(reinterpret_cast<RTCHitN*>(&ray.hit), n, i) = RTC_INVALID_GEOMETRY_ID;
}
template <typename RayHit>
BareHit hit_of(RayHit& ray, unsigned n, unsigned i) {
  auto* hits = reinterpret_cast<RTCHitN*>(&ray.hit);
  return {RTCRayN_tfar(reinterpret_cast<RTCRayN*>(&ray.ray), n, i),
          {RTCHitN_Ng_x(hits, n, i), RTCHitN_Ng_y(hits, n, i), RTCHitN_Ng_z(hits, n, i)},
          RTCHitN_primID(hits, n, i)};
}

void lidars_bare_single(benchmark::State& state) {
  const Strewn& all = strewn(static_cast<int>(state.range(0)));
  const std::vector<BareFan> fans = make_bare_fans();
  std::vector<BareHit> hits(beams);
  std::size_t next = 0;
  for (auto _ : state) {
    const BareFan& fan = fans[next++ % fans.size()];
    for (int i = 0; i < beams; ++i) {
      sim::RayQuery query(false);
      RTCRayHit ray;
      aim(ray, 1, 0, fan.origin, fan.directions[i].data(), range_m);
      query.intersect(all.bare->get(), ray);
      hits[i] = hit_of(ray, 1, 0);
    }
    benchmark::DoNotOptimize(hits.data());
  }
  per_ray(state);
}

void bare_packets(RTCScene scene, const float* origin, const std::array<float, 3>* directions, int count, float range,
                  BareHit* hits, bool coherent) {
  for (int first = 0; first < count; first += 8) {
    sim::RayQuery query(coherent);
    alignas(64) int valid[8];
    RTCRayHit8 rays;
    for (int i = 0; i < 8; ++i) {
      valid[i] = first + i < count ? -1 : 0;
      aim(rays, 8, i, origin, directions[std::min(first + i, count - 1)].data(), range);
    }
    query.intersect(scene, valid, rays);
    for (int i = 0; i < 8 && first + i < count; ++i) hits[first + i] = hit_of(rays, 8, i);
  }
}

void lidars_bare_packets(benchmark::State& state, bool coherent) {
  const Strewn& all = strewn(static_cast<int>(state.range(0)));
  const std::vector<BareFan> fans = make_bare_fans();
  std::vector<BareHit> hits(beams);
  std::size_t next = 0;
  for (auto _ : state) {
    const BareFan& fan = fans[next++ % fans.size()];
    bare_packets(all.bare->get(), fan.origin, fan.directions.data(), beams, range_m, hits.data(), coherent);
    benchmark::DoNotOptimize(hits.data());
  }
  per_ray(state);
}

/// Looks over the site from a mast; 45 degrees from left to right.  Tile by tile.
std::vector<Ray> camera_rays() {
  const sim::Pose X_WC = sim::make_pose({10, 10, 6}, {0, 0.25, pi / 4});
  std::vector<Ray> rays;
  const double focus = columns / 2 / std::tan(pi / 8);
  for (int top = 0; top < rows; top += tile)
    for (int left = 0; left < columns; left += tile)
      for (int row = top; row < top + tile; ++row)
        for (int column = left; column < left + tile; ++column)
          rays.push_back(
              {X_WC.translation(),
               X_WC.linear() * Vector3d(focus, columns / 2 - column - 0.5, rows / 2 - row - 0.5).normalized(), 200});
  return rays;
}

const Vector3d sun_W = Vector3d(0.3, -0.5, 0.8).normalized();

/// A frame in lists of 64 rays; with a shadow ray from each hit.
void camera_ours(benchmark::State& state, bool shadows) {
  const Strewn& all = strewn(static_cast<int>(state.range(0)));
  const std::vector<Ray> rays = camera_rays();
  std::vector<RayHit> hits(rays.size());
  std::vector<Ray> to_sun;
  std::vector<std::uint8_t> blocked(tile * tile);
  for (auto _ : state)
    for (std::size_t first = 0; first < rays.size(); first += tile * tile) {
      const std::span<const Ray> list(&rays[first], tile * tile);
      const std::span<RayHit> seen(&hits[first], tile * tile);
      all.scene->cast(list, {}, seen);
      if (!shadows) continue;
      to_sun.clear();
      for (std::size_t i = 0; i < list.size(); ++i)
        if (seen[i].hit())
          to_sun.push_back(
              {list[i].origin_W + seen[i].range_m * list[i].direction_W + 1e-3 * seen[i].normal_W, sun_W, 1000});
      all.scene->find_blocked(to_sun, {}, std::span(blocked).first(to_sun.size()));
      benchmark::DoNotOptimize(blocked.data());
    }
}

/// Shadow rays of up to `count` hits, in packets; returns how many are blocked.
int bare_shadows(RTCScene scene, const float* origin, const std::array<float, 3>* directions, int count,
                 const BareHit* hits, bool coherent) {
  const Eigen::Vector3f to_sun = sun_W.cast<float>();
  int blocked = 0;
  for (int first = 0; first < count; first += 8) {
    sim::RayQuery query(coherent);
    alignas(64) int valid[8];
    RTCRay8 rays;
    auto* const all = reinterpret_cast<RTCRayN*>(&rays);
    for (int i = 0; i < 8; ++i) {
      const int ray = std::min(first + i, count - 1);
      const BareHit& hit = hits[ray];
      const Eigen::Vector3f normal = Eigen::Vector3f(hit.normal[0], hit.normal[1], hit.normal[2]).normalized();
      const bool seen = first + i < count && hit.range < camera_range_m;
      valid[i] = seen ? -1 : 0;
      for (int axis = 0; axis < 3; ++axis) {
        const float facing = normal.dot(Eigen::Vector3f(directions[ray].data())) > 0 ? -1.0F : 1.0F;
        const float at = origin[axis] + hit.range * directions[ray][axis] + 1e-3F * facing * normal[axis];
        (axis == 0 ? rays.org_x : axis == 1 ? rays.org_y : rays.org_z)[i] = seen ? at : 0;
      }
      RTCRayN_dir_x(all, 8, i) = to_sun.x();
      RTCRayN_dir_y(all, 8, i) = to_sun.y();
      RTCRayN_dir_z(all, 8, i) = to_sun.z();
      RTCRayN_tnear(all, 8, i) = RTCRayN_time(all, 8, i) = 0;
      RTCRayN_tfar(all, 8, i) = seen ? 1000.0F : -1.0F;
      RTCRayN_mask(all, 8, i) = ~0u;
      RTCRayN_flags(all, 8, i) = 0;
    }
    query.find_occluded(scene, valid, rays);
    for (int i = 0; i < 8; ++i) blocked += valid[i] != 0 && RTCRayN_tfar(all, 8, i) < 0;
  }
  return blocked;
}

void camera_bare(benchmark::State& state, bool coherent, bool shadows) {
  const Strewn& all = strewn(static_cast<int>(state.range(0)));
  const std::vector<Ray> rays = camera_rays();
  const Eigen::Vector3f p = rays[0].origin_W.cast<float>();
  std::vector<std::array<float, 3>> directions;
  for (const Ray& ray : rays) {
    const Eigen::Vector3f d = ray.direction_W.cast<float>();
    directions.push_back({d.x(), d.y(), d.z()});
  }
  std::vector<BareHit> hits(rays.size());
  for (auto _ : state) {
    const int count = static_cast<int>(rays.size());
    bare_packets(all.bare->get(), p.data(), directions.data(), count, camera_range_m, hits.data(), coherent);
    if (shadows)
      benchmark::DoNotOptimize(
          bare_shadows(all.bare->get(), p.data(), directions.data(), count, hits.data(), coherent));
  }
}

template <typename Update>
void measure_update(benchmark::State& state, Strewn& all, Update&& update) {
  for (auto _ : state) {
    all.move_all();
    const auto start = std::chrono::steady_clock::now();
    update();
    state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
}
void update_ours(benchmark::State& state) {
  Strewn all(static_cast<int>(state.range(0)), false);
  measure_update(state, all, [&] { all.scene->prepare(); });
}
void update_bare(benchmark::State& state) {
  Strewn all(static_cast<int>(state.range(0)), false);
  measure_update(state, all, [&] { all.bare->update(); });
}

}  // namespace

BENCHMARK(lidars_bare_single)->RangeMultiplier(10)->Range(10, 10000);
BENCHMARK_CAPTURE(lidars_bare_packets, incoherent, false)->RangeMultiplier(10)->Range(10, 10000);
BENCHMARK_CAPTURE(lidars_bare_packets, coherent, true)->RangeMultiplier(10)->Range(10, 10000);
BENCHMARK(lidars_ours)->RangeMultiplier(10)->Range(10, 10000);
BENCHMARK_CAPTURE(camera_bare, incoherent, false, false)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(camera_bare, coherent, true, false)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(camera_bare, incoherent_with_shadows, false, true)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(camera_bare, coherent_with_shadows, true, true)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(camera_ours, rays_alone, false)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(camera_ours, with_shadows, true)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK(update_bare)->Arg(1000)->Arg(10000)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(update_ours)->Arg(1000)->Arg(10000)->UseManualTime()->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
