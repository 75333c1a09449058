// SPDX-License-Identifier: BSD-3-Clause
// Embree's scene against ODE's, two libraries that share no code for rays, in random worlds.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/scratch_folder.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace small_worlds;
using sim::Ray;
using sim::RayFilter;
using sim::RayHit;
using sim::RayLibrary;

using std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();

class Uniform {
 public:
  explicit Uniform(unsigned seed) : random_(seed) {}
  double operator()(double low, double high) { return low + (high - low) * (random_() / 4294967296.0); }
  unsigned below(unsigned count) { return static_cast<unsigned>(random_() % count); }
  Vector3d direction() {
    Vector3d d;
    do d = {(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)};
    while (d.squaredNorm() > 1 || d.squaredNorm() < 1e-3);
    return d.normalized();
  }

 private:
  std::mt19937 random_;
};

/// A closed mesh of 200 triangles: a sphere with dents.
const std::string& dented_ball() {
  static const test_support::ScratchFolder folder;
  static const std::string path = folder.file("dented_ball.obj");
  if (std::filesystem::exists(path)) return path;
  FILE* file = std::fopen(path.c_str(), "w");
  constexpr int rings = 11, around = 10;
  const auto put = [&](double polar, double turn, double r) {
    std::fprintf(file, "v %.9g %.9g %.9g\n", r * std::sin(polar) * std::cos(turn), r * std::sin(polar) * std::sin(turn),
                 r * std::cos(polar));
  };
  put(0, 0, 1);
  for (int ring = 1; ring < rings; ++ring)
    for (int k = 0; k < around; ++k)
      put(pi * ring / rings, 2 * pi * k / around, 1 + 0.3 * std::sin(2.0 * ring + 3.0 * k));
  put(pi, 0, 1);
  const auto number = [](int ring, int k) { return 2 + (ring - 1) * around + k % around; };
  for (int k = 0; k < around; ++k) std::fprintf(file, "f 1 %d %d\n", number(1, k), number(1, k + 1));
  for (int ring = 1; ring + 1 < rings; ++ring)
    for (int k = 0; k < around; ++k) {
      std::fprintf(file, "f %d %d %d\n", number(ring, k), number(ring + 1, k), number(ring + 1, k + 1));
      std::fprintf(file, "f %d %d %d\n", number(ring, k), number(ring + 1, k + 1), number(ring, k + 1));
    }
  const int last = 2 + (rings - 1) * around;
  for (int k = 0; k < around; ++k)
    std::fprintf(file, "f %d %d %d\n", number(rings - 1, k), last, number(rings - 1, k + 1));
  std::fclose(file);
  return path;
}

/// Parts of every shape in a heap, half of them moving, around `center`; the same for the same seed.
struct Heap {
  Heap(RayLibrary library, unsigned seed, const Vector3d& center = Vector3d::Zero(), bool meshes = true) {
    Uniform uniform(seed);
    PhysicsConfig config;
    config.gravity_mps2 = 0;
    config.rays = library;
    world = make_world(config);
    add_ground(*world, translation(center.x(), center.y(), center.z() - 3));
    PartConfig mesh;
    mesh.shape = PartShape::mesh;
    mesh.mesh = dented_ball();
    for (int i = 0; i < 80; ++i) {
      std::vector<PartConfig> parts;
      for (unsigned k = 0; k <= uniform.below(3); ++k) {
        const double a = uniform(0.1, 2), b = uniform(0.1, 3), r = uniform(0.1, 0.8);
        const std::array<PartConfig, 4> shapes = {box({a, b, r}, 1), sphere(r, 1), round(PartShape::capsule, r, b, 1),
                                                  round(PartShape::cylinder, r, a, 1)};
        PartConfig part = meshes && uniform.below(10) == 0 ? mesh : shapes[uniform.below(4)];
        if (part.shape == PartShape::mesh) part.mass_kg = 1;
        part.name = std::string(word_of(sim::part_shape_words, part.shape)) + std::to_string(k);
        const Vector3d position(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
        configs.push_back(part);
        parts.push_back(at(part, position, {uniform(-3, 3), uniform(-1.5, 1.5), uniform(-3, 3)}));
      }
      const Vector3d p = center + Vector3d(uniform(-15, 15), uniform(-15, 15), uniform(-2, 2));
      bodies.push_back(&add(*world, body("b" + std::to_string(i), parts),
                            sim::make_pose(p, {uniform(-3, 3), 0, uniform(-3, 3)}),
                            i % 2 == 0 ? Motion::fixed : Motion::free));
    }
  }
  const sim::Scene& scene() const { return world->scene(); }
  std::string name_of(int part) const { return part < 0 ? "nothing" : world->parts()[part].name; }
  /// Where the ray starts and goes in the frame of a part.
  std::string local(int part, const Ray& ray) const {
    if (part < 0) return "";
    const sim::Pose X_PW = world->X_WP(part).inverse();
    std::ostringstream text;
    text << ", from " << (X_PW * ray.origin_W).transpose() << " along "
         << (X_PW.linear() * ray.direction_W).transpose();
    return text.str();
  }
  bool is_mesh(int part) const { return name_of(part).find("/mesh") != std::string::npos; }

  /// The ray begins in a capsule and the hit is where it leaves it, by the distance from the capsule's axis.  ODE loses
  /// the far cap then.
  bool leaves_capsule(const RayHit& hit, const Ray& ray) const {
    if (!hit.hit() || configs[hit.part].shape != PartShape::capsule) return false;
    const double half = configs[hit.part].length_m / 2, radius = configs[hit.part].radius_m;
    const auto depth_m = [&](const Vector3d& p_W) {
      const Vector3d p = world->X_WP(hit.part).inverse() * p_W;
      return radius - (p - Vector3d(0, 0, std::clamp(p.z(), -half, half))).norm();
    };
    return depth_m(ray.origin_W) > 0 && std::abs(depth_m(ray.origin_W + hit.range_m * ray.direction_W)) < 1e-9;
  }

  std::unique_ptr<PhysicsWorld> world;
  std::vector<sim::Body*> bodies;
  std::vector<PartConfig> configs{plane()};  // by part number
};

std::vector<Ray> random_rays(Uniform& uniform, int count, const Vector3d& center = Vector3d::Zero()) {
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const Vector3d from = center + Vector3d(uniform(-18, 18), uniform(-18, 18), uniform(-3, 5));
    rays.push_back({from, uniform.direction(), uniform(1, 60)});
  }
  return rays;
}

std::vector<RayHit> cast(const sim::Scene& scene, const std::vector<Ray>& rays, const RayFilter& filter = {}) {
  std::vector<RayHit> hits(rays.size());
  scene.cast(rays, filter, hits);
  return hits;
}

bool equal_bits(const RayHit& a, const RayHit& b) {
  return a.range_m == b.range_m && a.part == b.part && a.normal_W == b.normal_W && a.material == b.material;
}

/// Another hit when the ray is put aside by this much: it grazes an edge, and rounding decides.
bool grazes(const sim::Scene& scene, const Ray& ray, double range_m, double aside_m) {
  const Vector3d u = ray.direction_W.unitOrthogonal(), v = ray.direction_W.cross(u);
  for (const Vector3d& side : {u, Vector3d(-u), v, Vector3d(-v)}) {
    const auto hit = scene.cast(ray.origin_W + aside_m * side, ray.direction_W, ray.range_max_m, {});
    if (std::abs((hit ? hit->range_m : infinity) - range_m) < 1e-4) return true;
  }
  return false;
}

TEST(EmbreeScene, SeesWhatOdeSees) {
  int rays_cast = 0, hit = 0, grazing = 0, in_capsule = 0;
  double max_of_shapes_m = 0, max_of_meshes_m = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Heap embree(RayLibrary::embree, seed), ode(RayLibrary::ode, seed);
    Uniform uniform(1000 + seed);
    const std::vector<Ray> rays = random_rays(uniform, 5000);
    const std::vector<RayHit> ours = cast(embree.scene(), rays), theirs = cast(ode.scene(), rays);
    std::vector<std::uint8_t> blocked(rays.size());
    embree.scene().find_blocked(rays, {}, blocked);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ++rays_cast;
      hit += ours[i].hit();
      ASSERT_EQ(blocked[i] == 1, ours[i].hit()) << seed << " " << i;
      const double difference = ours[i].hit() == theirs[i].hit()
                                    ? ours[i].hit() ? std::abs(ours[i].range_m - theirs[i].range_m) : 0
                                    : infinity;
      const bool mesh = embree.is_mesh(ours[i].part) || ode.is_mesh(theirs[i].part);
      if (difference <= 1e-5) {
        double& largest = mesh ? max_of_meshes_m : max_of_shapes_m;
        largest = std::max(largest, difference);
        if (ours[i].hit() && ours[i].part == theirs[i].part) {
          EXPECT_NEAR((ours[i].normal_W - theirs[i].normal_W).norm(), 0, mesh ? 1e-4 : 1e-5) << seed << " " << i;
        }
      } else if (grazes(embree.scene(), rays[i], theirs[i].range_m, mesh ? 1e-5 : 1e-9)) {
        ++grazing;
      } else if (embree.leaves_capsule(ours[i], rays[i])) {
        ++in_capsule;
      } else {
        ADD_FAILURE() << "seed " << seed << " ray " << i << ": " << ours[i].range_m << " "
                      << embree.name_of(ours[i].part) << " against " << theirs[i].range_m << " "
                      << ode.name_of(theirs[i].part) << embree.local(ours[i].part, rays[i]);
      }
    }
  }
  RecordProperty("largest_of_shapes_nm", static_cast<int>(1e9 * max_of_shapes_m));
  RecordProperty("largest_of_meshes_nm", static_cast<int>(1e9 * max_of_meshes_m));
  EXPECT_GT(hit, rays_cast / 3);  // the test saw something
  EXPECT_LT(grazing, rays_cast / 1000);
  EXPECT_LT(in_capsule, rays_cast / 1000);
  EXPECT_LT(max_of_shapes_m, 1e-9);
}

TEST(EmbreeScene, SeesTerrainAsOdeDoes) {
  const auto world_of = [](RayLibrary library) {
    PhysicsConfig config;
    config.rays = library;
    auto world = std::make_unique<PhysicsWorld>(config, std::vector<MaterialConfig>{{"mud"}},
                                                std::vector<ContactConfig>{}, std::vector<std::string>{}, 1);
    PartConfig ground = plane();
    ground.shape = PartShape::terrain;
    sim::TerrainConfig& terrain = ground.terrain.emplace();
    terrain.source = sim::TerrainConfig::Source::fractal;
    terrain.size_m = {60, 40};
    terrain.cell_m = 0.5;
    terrain.amplitude_m = 3;
    terrain.wavelength_m = 15;
    sim::TerrainAreaConfig area;
    area.material = "mud";
    area.shape = sim::TerrainAreaConfig::Shape::circle;
    area.radius_m = 12;
    terrain.areas.push_back(area);
    add(*world, body("ground", {ground}), sim::make_pose({100, 50, 5}, {0.05, -0.1, 0.7}), Motion::fixed);
    return world;
  };
  const auto embree = world_of(RayLibrary::embree), ode = world_of(RayLibrary::ode);
  Uniform uniform(4);
  std::vector<Ray> rays;
  for (int i = 0; i < 100000; ++i) {
    const Vector3d from(100 + uniform(-25, 25), 50 + uniform(-15, 15), uniform(8, 14));
    const Vector3d to(100 + uniform(-25, 25), 50 + uniform(-15, 15), uniform(0, 8));
    rays.push_back({from, (to - from).normalized(), uniform(10, 80)});
  }
  const std::vector<RayHit> ours = cast(embree->scene(), rays), theirs = cast(ode->scene(), rays);
  int hit = 0, mud = 0, on_edge = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hit += ours[i].hit();
    mud += ours[i].hit() && embree->material(ours[i].material).name == "mud";
    // ODE's meshes are in single precision: 1e-5 m, more at grazing incidence.
    const double steep = ours[i].hit() ? -ours[i].normal_W.dot(rays[i].direction_W) : 1;
    if (ours[i].hit() == theirs[i].hit() && ours[i].material == theirs[i].material &&
        (!ours[i].hit() || std::abs(ours[i].range_m - theirs[i].range_m) <= 1e-5 / steep))
      continue;
    // What else differs lies on an edge, so that as small a step aside makes either library see what the other one
    // does: Embree where a ray passes a crest, ODE where it falls between two cells.
    if (grazes(embree->scene(), rays[i], theirs[i].range_m, 1e-5) ||
        grazes(ode->scene(), rays[i], ours[i].range_m, 1e-5))
      ++on_edge;
    else
      ADD_FAILURE() << "ray " << i << ": " << ours[i].range_m << " against " << theirs[i].range_m;
  }
  EXPECT_GT(hit, 50000);
  EXPECT_GT(mud, 5000);
  EXPECT_GT(hit - mud, 5000);
  EXPECT_LE(on_edge, 5);  // seen: 1 of a million
}

TEST(EmbreeScene, KeepsItsPrecisionFarFromTheOrigin) {
  // UTM coordinates; a whole number of binary fractions, so that poses are not rounded by the offset.
  const Vector3d far(500032, 4500992, 64);
  const Heap near_heap(RayLibrary::embree, 5), far_heap(RayLibrary::embree, 5, far);
  Uniform uniform(3), again(3);
  const std::vector<RayHit> near_hits = cast(near_heap.scene(), random_rays(uniform, 20000));
  const std::vector<RayHit> far_hits = cast(far_heap.scene(), random_rays(again, 20000, far));
  int differ = 0;
  for (std::size_t i = 0; i < near_hits.size(); ++i) {
    if (!near_hits[i].hit() && !far_hits[i].hit()) continue;
    // Doubles have steps of 1e-9 m there.
    if (near_hits[i].part != far_hits[i].part || std::abs(near_hits[i].range_m - far_hits[i].range_m) > 1e-6) ++differ;
  }
  EXPECT_LE(differ, 4);  // rays that graze an edge
}

TEST(EmbreeScene, SeesFromFarOutsideTheHeap) {
  const Heap embree(RayLibrary::embree, 2, Vector3d::Zero(), false), ode(RayLibrary::ode, 2, Vector3d::Zero(), false);
  Uniform uniform(9);
  std::vector<Ray> rays;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d from = 20000 * uniform.direction();
    const Vector3d to(uniform(-10, 10), uniform(-10, 10), uniform(-2, 2));
    rays.push_back({from, (to - from).normalized(), i % 2 ? infinity : 30000});
  }
  const std::vector<RayHit> ours = cast(embree.scene(), rays), theirs = cast(ode.scene(), rays);
  int differ = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (std::isinf(rays[i].range_max_m)) {
      EXPECT_EQ(ours[i].hit(), cast(embree.scene(), {{rays[i].origin_W, rays[i].direction_W, 1e6}})[0].hit());
      continue;
    }
    if (ours[i].hit() != theirs[i].hit() || (ours[i].hit() && std::abs(ours[i].range_m - theirs[i].range_m) > 1e-6))
      ++differ;
  }
  EXPECT_LE(differ, 2);  // rays that graze an edge
}

/// As a list, alone, and backwards, which packs the rays another way.
TEST(EmbreeScene, OfOneRayReportsTheSameWhateverRaysAreCastWithIt) {
  const Heap heap(RayLibrary::embree, 7);
  Uniform uniform(8);
  std::vector<Ray> rays = random_rays(uniform, 20000);
  const std::vector<RayHit> list = cast(heap.scene(), rays);
  std::reverse(rays.begin(), rays.end());
  std::vector<RayHit> backwards = cast(heap.scene(), rays);
  std::reverse(rays.begin(), rays.end());
  std::reverse(backwards.begin(), backwards.end());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto alone = heap.scene().cast(rays[i].origin_W, rays[i].direction_W, rays[i].range_max_m, {});
    ASSERT_TRUE(equal_bits(list[i], alone.value_or(RayHit{}))) << i;
    ASSERT_TRUE(equal_bits(list[i], backwards[i])) << i;
  }
}

TEST(EmbreeScene, OfAFanReportsWhatItReportsEachRay) {
  const Heap heap(RayLibrary::embree, 7);
  Uniform uniform(18);
  for (int k = 0; k < 50; ++k) {
    sim::Fan fan;
    fan.X_WS =
        sim::make_pose({uniform(-15, 15), uniform(-15, 15), uniform(-1, 1)}, {uniform(-1, 1), 0, uniform(-3, 3)});
    fan.first_angle_rad = uniform(-3, 3);
    fan.step_rad = 0.01;
    fan.count = 1 + static_cast<int>(uniform.below(300));
    fan.range_max_m = 30;
    std::vector<RayHit> hits(fan.count);
    heap.scene().cast_fan(fan, {}, hits);
    for (int i = 0; i < fan.count; ++i) {
      const double angle_rad = fan.first_angle_rad + i * fan.step_rad;
      const Vector3d direction_W = fan.X_WS.linear() * Vector3d(std::cos(angle_rad), std::sin(angle_rad), 0);
      const auto alone = heap.scene().cast(fan.X_WS.translation(), direction_W, 30, {});
      ASSERT_TRUE(equal_bits(hits[i], alone.value_or(RayHit{}))) << k << " " << i;
    }
  }
}

/// The tree of one scene was widened as the bodies moved, that of the other was built when they had arrived.
TEST(EmbreeScene, ReportsTheSameWhateverHappenedBefore) {
  Heap moved(RayLibrary::embree, 4), arrived(RayLibrary::embree, 4);
  Uniform uniform(6);
  const std::vector<Ray> rays = random_rays(uniform, 5000);
  const auto move = [&](Heap& heap, double by) {
    for (std::size_t i = 1; i < heap.bodies.size(); i += 2) {
      const sim::Pose X_W = heap.bodies[i]->X_WB();
      heap.bodies[i]->set_pose(sim::make_pose({by * (i % 7), by, 0.125 * (i % 3)}, {0, 0, 0.5}) * X_W);
    }
  };
  for (int k = 0; k < 20; ++k) {
    move(moved, 0.0625);
    cast(moved.scene(), {rays[0]});
    move(arrived, 0.0625);
  }
  // A group was added and removed.
  const int guest = arrived.world->add_group("guest");
  arrived.world->add_body(guest, body("guest", {box({1, 1, 1}, 1)}), Pose::Identity(), Motion::free);
  arrived.world->close_group(guest);
  cast(arrived.scene(), {rays[0]});
  arrived.world->remove_group(guest);
  const std::vector<RayHit> a = cast(moved.scene(), rays), b = cast(arrived.scene(), rays);
  for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_TRUE(equal_bits(a[i], b[i])) << i;
}

TEST(EmbreeScene, ReportsSeveralThreadsAtOnce) {
  const Heap heap(RayLibrary::embree, 3);
  heap.scene().prepare();
  ASSERT_TRUE(heap.scene().concurrent());
  Uniform uniform(2);
  const std::vector<Ray> rays = random_rays(uniform, 10000);
  std::array<std::vector<RayHit>, 4> hits;
  std::vector<std::thread> threads;
  for (auto& own : hits) threads.emplace_back([&heap, &rays, &own] { own = cast(heap.scene(), rays); });
  for (std::thread& thread : threads) thread.join();
  for (const auto& each : hits)
    for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_TRUE(equal_bits(each[i], hits[0][i])) << i;
}

}  // namespace
