// SPDX-License-Identifier: BSD-3-Clause
#include "sim/scene/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "tests/scratch_folder.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace small_worlds;
using sim::RayFilter;
using sim::RayHit;
using sim::RayLibrary;

using std::numbers::pi;

struct Hit {
  double range_m;
  Vector3d normal;
};

/// Each test runs with each library.
class RayTest : public testing::TestWithParam<RayLibrary> {
 protected:
  std::unique_ptr<PhysicsWorld> make_world(PhysicsConfig config = {}) const {
    config.rays = GetParam();
    return small_worlds::make_world(config);
  }
  std::optional<RayHit> look_at(const PartConfig& part, const Vector3d& from, const Vector3d& direction) const;
  std::unique_ptr<PhysicsWorld> random_scene(std::mt19937& random) const;
};

const auto libraries = testing::Values(RayLibrary::embree, RayLibrary::ode);
const auto library_name = [](const auto& info) { return std::string(word_of(sim::ray_library_words, info.param)); };

class Ray : public RayTest {};
class Filter : public RayTest {};
class SceneOf : public RayTest {};
class Fan : public RayTest {};
class Cast : public RayTest {};
INSTANTIATE_TEST_SUITE_P(With, Ray, libraries, library_name);
INSTANTIATE_TEST_SUITE_P(With, Filter, libraries, library_name);
INSTANTIATE_TEST_SUITE_P(With, SceneOf, libraries, library_name);
INSTANTIATE_TEST_SUITE_P(With, Fan, libraries, library_name);
INSTANTIATE_TEST_SUITE_P(With, Cast, libraries, library_name);

/// One fixed body of one part at (5, 0, 0), seen from the origin.
std::optional<RayHit> RayTest::look_at(const PartConfig& part, const Vector3d& from, const Vector3d& direction) const {
  const auto world = make_world();
  add(*world, body("target", {part}), translation(5, 0, 0), Motion::fixed);
  return world->scene().cast(from, direction.normalized(), 100, {});
}

void expect_hit(const std::optional<RayHit>& found, const Hit& expected) {
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->range_m, expected.range_m, 1e-9);
  EXPECT_NEAR((found->normal_W - expected.normal).norm(), 0, 1e-9) << found->normal_W.transpose();
  EXPECT_EQ(found->part, 0);
}

TEST_P(Ray, HitsTheNearFaceOfABox) {
  expect_hit(look_at(box({2, 4, 6}, 0), {0, 1, 2}, {1, 0, 0}), {4, {-1, 0, 0}});
  expect_hit(look_at(box({2, 4, 6}, 0), {5, 10, 0}, {0, -1, 0}), {8, {0, 1, 0}});
  // Turned by 45 degrees a cube of side 2 shows its edge, beside which the ray runs down a face.
  expect_hit(look_at(at(box({2, 2, 2}, 0), {0, 0, 0}, {0, 0, pi / 4}), {0, 0.5, 0}, {1, 0, 0}),
             {5 - std::sqrt(2) + 0.5, {-std::sqrt(0.5), std::sqrt(0.5), 0}});
}

TEST_P(Ray, MayPointAlongMinusZero) {
  expect_hit(look_at(box({2, 4, 6}, 0), {20, 1, 2}, -Vector3d::UnitX()), {14, {1, 0, 0}});
  expect_hit(look_at(box({2, 4, 6}, 0), {5, 1, 20}, -Vector3d::UnitZ()), {17, {0, 0, 1}});
}

TEST_P(Ray, HitsASphere) {
  expect_hit(look_at(sphere(1, 0), {0, 0, 0}, {1, 0, 0}), {4, {-1, 0, 0}});
  expect_hit(look_at(sphere(1, 0), {0, 0.6, 0}, {1, 0, 0}), {5 - 0.8, {-0.8, 0.6, 0}});
}

TEST_P(Ray, HitsTheSideAndTheCapOfACapsule) {
  const PartConfig capsule = round(PartShape::capsule, 1, 4, 0);
  expect_hit(look_at(capsule, {0, 0.6, 1}, {1, 0, 0}), {5 - 0.8, {-0.8, 0.6, 0}});
  expect_hit(look_at(capsule, {0, 0, 2.6}, {1, 0, 0}), {5 - 0.8, {-0.8, 0, 0.6}});
  expect_hit(look_at(capsule, {5, 0, 10}, {0, 0, -1}), {7, {0, 0, 1}});
}

TEST_P(Ray, HitsTheSideAndTheEndOfACylinder) {
  const PartConfig cylinder = round(PartShape::cylinder, 1, 4, 0);
  expect_hit(look_at(cylinder, {0, 0.6, 1}, {1, 0, 0}), {5 - 0.8, {-0.8, 0.6, 0}});
  expect_hit(look_at(cylinder, {5.5, 0, 10}, {0, 0, -1}), {8, {0, 0, 1}});
  EXPECT_FALSE(look_at(cylinder, {0, 0, 2.1}, {1, 0, 0}).has_value());
  // Lying along y.
  expect_hit(look_at(at(cylinder, {0, 0, 0}, {pi / 2, 0, 0}), {0, 1.9, 0.6}, {1, 0, 0}), {5 - 0.8, {-0.8, 0, 0.6}});
}

TEST_P(Ray, HitsAPlaneAtAnAngle) {
  // 45 degrees down from 3 m.
  expect_hit(look_at(plane(), {0, 0, 3}, {1, 0, -1}), {3 * std::sqrt(2), {0, 0, 1}});
  EXPECT_FALSE(look_at(plane(), {0, 0, 3}, {1, 0, 1}).has_value());
}

TEST_P(Ray, EndsAtItsRange) {
  const auto world = make_world();
  add(*world, body("target", {sphere(1, 0)}), translation(5, 0, 0), Motion::fixed);
  EXPECT_TRUE(world->scene().cast({0, 0, 0}, {1, 0, 0}, 4.001, {}).has_value());
  EXPECT_FALSE(world->scene().cast({0, 0, 0}, {1, 0, 0}, 3.999, {}).has_value());
  EXPECT_TRUE(world->scene().occluded({0, 0, 0}, {10, 0, 0}, {}));
  EXPECT_FALSE(world->scene().occluded({0, 0, 0}, {0, 10, 0}, {}));
}

TEST_P(Ray, HitsTheNearestOfMany) {
  const auto world = make_world();
  for (const double x : {30.0, 10.0, 20.0})
    add(*world, body("b" + std::to_string(x), {box({2, 2, 2}, 0)}), translation(x, 0, 0), Motion::fixed);
  const auto hit = world->scene().cast({0, 0, 0}, {1, 0, 0}, 100, {});
  ASSERT_TRUE(hit.has_value());
  EXPECT_EQ(hit->part, 1);
  EXPECT_NEAR(hit->range_m, 9, 1e-12);
  EXPECT_EQ(world->parts()[1].name, "b10.000000/b10.000000/1");
}

TEST_P(Ray, OfTwoPartsInOnePlaceHitsTheLowerNumber) {
  const auto world = make_world();
  for (const char* name : {"a", "b"}) add(*world, body(name, {box({2, 2, 2}, 0)}), translation(5, 0, 0), Motion::fixed);
  EXPECT_EQ(world->scene().cast({0, 0, 0}, {1, 0, 0}, 100, {})->part, 0);
}

TEST_P(Ray, HitsAMesh) {
  // A tetrahedron standing on z = 0, its slope towards -x through (-1, y, 0) and (0, 0, 1).
  PartConfig part;
  part.shape = PartShape::mesh;
  const test_support::ScratchFolder folder;
  part.mesh = folder.file("tetrahedron.obj");
  FILE* file = std::fopen(part.mesh.c_str(), "w");
  ASSERT_NE(file, nullptr);
  std::fputs("v -1 -1 0\nv -1 1 0\nv 2 0 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n", file);
  std::fclose(file);
  const auto world = make_world();
  add(*world, body("target", {part}), translation(5, 0, 0), Motion::fixed);
  const auto hit = world->scene().cast({0, 0, 0.5}, {1, 0, 0}, 100, {});
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(hit->range_m, 4.5, 1e-6);  // the mesh collider works in single precision
  std::vector<RayHit> seen(1);
  world->scene().cast_fan({translation(0, 0, 0.5), 0, 0.1, 1, 100}, {}, seen);
  EXPECT_EQ(seen[0].range_m, hit->range_m);
}

TEST_P(Filter, SeesOnlyItsCategoriesAndNotItsOwnGroup) {
  PhysicsConfig config;
  config.rays = GetParam();
  PhysicsWorld world(config, {}, {}, {"glass"}, 1);
  PartConfig pane = box({0.1, 2, 2}, 0);
  pane.category = "glass";
  add(world, body("pane", {pane}), translation(2, 0, 0), Motion::fixed);
  const int rover = world.add_group("rover");
  world.add_body(rover, body("hull", {box({1, 1, 1}, 5)}, {4, 0, 0}), Pose::Identity());
  world.close_group(rover);
  add(world, body("wall", {box({0.2, 9, 9}, 0)}), translation(6, 0, 0), Motion::fixed);
  const auto part_seen = [&](const RayFilter& filter) {
    const auto hit = world.scene().cast({0, 0, 0}, {1, 0, 0}, 100, filter);
    std::vector<RayHit> fan(1);
    world.scene().cast_fan({Pose::Identity(), 0, 0.1, 1, 100}, filter, fan);
    EXPECT_EQ(fan[0].range_m, hit ? hit->range_m : std::numeric_limits<double>::infinity());
    return hit ? hit->part : -1;
  };
  EXPECT_EQ(part_seen({}), 0);
  EXPECT_EQ(part_seen({world.category_bit("solid"), -1}), 1);
  EXPECT_EQ(part_seen({world.category_bit("solid"), rover}), 2);
  EXPECT_EQ(part_seen({world.category_bit("glass"), rover}), 0);
  EXPECT_EQ(part_seen({0, -1}), -1);
}

TEST_P(SceneOf, SeesBodiesWhereTheyAreAfterTheStep) {
  PhysicsConfig config;
  config.gravity_mps2 = 0;
  const auto world = make_world(config);
  sim::Body& drone = add(*world, body("drone", {sphere(1, 1)}), translation(5, 0, 0));
  sim::Body& door = add(*world, body("door", {box({1, 9, 9}, 0)}), translation(20, 0, 0), Motion::fixed);
  const auto range = [&] { return world->scene().cast({0, 0, 0}, {1, 0, 0}, 100, {})->range_m; };
  EXPECT_NEAR(range(), 4, 1e-12);
  drone.set_velocity_W({10, 0, 0}, {0, 0, 0});
  world->step(0);
  EXPECT_NEAR(range(), 4.1, 1e-12);
  drone.set_pose(translation(0, 50, 0));
  EXPECT_NEAR(range(), 19.5, 1e-12);
  door.set_pose(translation(30, 0, 0));
  EXPECT_NEAR(range(), 29.5, 1e-12);
}

TEST_P(Fan, SeesASquareRoom) {
  const auto world = make_world();
  add_ground(*world);
  const Pose walls[] = {translation(2.5, 0, 0), translation(-2.5, 0, 0), translation(0, 2.5, 0),
                        translation(0, -2.5, 0)};
  for (int i = 0; i < 4; ++i)
    add(*world, body("wall" + std::to_string(i), {box(i < 2 ? Vector3d(1, 6, 2) : Vector3d(6, 1, 2), 0)}),
        walls[i] * translation(0, 0, 1), Motion::fixed);
  sim::Fan fan;
  fan.X_WS = translation(0, 0, 0.5);
  fan.first_angle_rad = -pi;
  fan.count = 360;
  fan.step_rad = 2 * pi / fan.count;
  fan.range_max_m = 10;
  std::vector<RayHit> hits(360);
  world->scene().cast_fan(fan, {}, hits);
  for (int i = 0; i < fan.count; ++i) {
    const double angle = fan.first_angle_rad + i * fan.step_rad;
    EXPECT_NEAR(hits[i].range_m, 2 / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle))), 1e-9) << i;
  }
}

TEST_P(Fan, TiltedDownSeesTheGround) {
  const auto world = make_world();
  add_ground(*world);
  std::vector<RayHit> hits(3);
  // Pitched down by 30 degrees at 1 m: the middle beam runs 2 m.
  world->scene().cast_fan({sim::make_pose({0, 0, 1}, {0, pi / 6, 0}), -pi / 2, pi / 2, 3, 5}, {}, hits);
  EXPECT_EQ(hits[0].range_m, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(hits[1].range_m, 2, 1e-12);
  EXPECT_EQ(hits[2].range_m, std::numeric_limits<double>::infinity());
}

TEST_P(Ray, ThatBeginsInsideEndsWhereItLeaves) {
  expect_hit(look_at(box({2, 4, 6}, 0), {5.5, 0, 0}, {1, 0, 0}), {0.5, {-1, 0, 0}});
  expect_hit(look_at(sphere(1, 0), {5.5, 0, 0}, {1, 0, 0}), {0.5, {-1, 0, 0}});
  expect_hit(look_at(round(PartShape::cylinder, 1, 4, 0), {5.5, 0, 0}, {1, 0, 0}), {0.5, {-1, 0, 0}});
  expect_hit(look_at(round(PartShape::cylinder, 1, 4, 0), {5.5, 0, 0}, {0, 0, 1}), {2, {0, 0, -1}});
  expect_hit(look_at(round(PartShape::capsule, 1, 4, 0), {5.5, 0, 0}, {1, 0, 0}), {0.5, {-1, 0, 0}});
  expect_hit(look_at(round(PartShape::capsule, 1, 4, 0), {5, 0, 0.5}, {0, 0, 1}), {2.5, {0, 0, -1}});
  // A plane has no inside: it is seen from both sides.
  expect_hit(look_at(plane(), {0, 0, -3}, {0, 0, 1}), {3, {0, 0, -1}});
}

TEST_P(Ray, AlongTheAxisOfARoundPartHitsItsEnd) {
  expect_hit(look_at(round(PartShape::cylinder, 1, 4, 0), {5, 0, -9}, {0, 0, 1}), {7, {0, 0, -1}});
  expect_hit(look_at(round(PartShape::capsule, 1, 4, 0), {5, 0, -9}, {0, 0, 1}), {6, {0, 0, -1}});
  EXPECT_FALSE(look_at(round(PartShape::cylinder, 1, 4, 0), {6.5, 0, -9}, {0, 0, 1}).has_value());
}

TEST_P(Ray, ReportsTheMaterialAndPassesWhatLetsItThrough) {
  PhysicsConfig config;
  config.rays = GetParam();
  sim::MaterialConfig glass{"glass"}, wood{"wood"};
  glass.transparent_to = {"laser", "light"};
  PhysicsWorld world(config, {glass, wood}, {}, {}, 1);
  PartConfig pane = box({0.1, 2, 2}, 0), door = box({0.1, 2, 2}, 0);
  pane.material = "glass";
  door.material = "wood";
  add(world, body("pane", {pane}), translation(2, 0, 0), Motion::fixed);
  add(world, body("door", {door}), translation(4, 0, 0), Motion::fixed);
  const auto material_seen = [&](sim::RayKind kind) {
    const RayFilter filter{~0u, -1, kind};
    const std::vector<sim::Ray> rays(3, sim::Ray{{0, 0, 0}, {1, 0, 0}, 3});
    std::vector<std::uint8_t> blocked(3);
    world.scene().find_blocked(rays, filter, blocked);
    EXPECT_EQ(blocked[2], !(glass.transmits() & static_cast<std::uint8_t>(kind)));
    return world.material(world.scene().cast({0, 0, 0}, {1, 0, 0}, 100, filter)->material).name;
  };
  EXPECT_EQ(material_seen(sim::RayKind::laser), "wood");
  EXPECT_EQ(material_seen(sim::RayKind::light), "wood");
  EXPECT_EQ(material_seen(sim::RayKind::sound), "glass");
  EXPECT_EQ(material_seen(sim::RayKind::any), "glass");
}

TEST_P(Ray, WithoutLengthOrDirectionHitsNothing) {
  const auto world = make_world();
  add(*world, body("around", {sphere(1, 0)}), Pose::Identity(), Motion::fixed);
  for (int i = 0; i < 9; ++i) add(*world, body("b" + std::to_string(i), {sphere(1, 1)}), translation(5, 0, 3 * i));
  const sim::Scene& scene = world->scene();
  EXPECT_FALSE(scene.cast({0, 0, 0}, {1, 0, 0}, 0, {}).has_value());
  EXPECT_FALSE(scene.cast({0, 0, 0}, {1, 0, 0}, -1, {}).has_value());
  EXPECT_FALSE(scene.cast({0, 0, 0}, {1, 0, 0}, std::nan(""), {}).has_value());
  const double nan = std::nan("");
  if (GetParam() == RayLibrary::embree) {  // ODE would end the program
    EXPECT_FALSE(scene.cast({nan, 0, 0}, {1, nan, 0}, 10, {}).has_value());
  }
  scene.cast(std::span<const sim::Ray>{}, {}, std::span<RayHit>{});
  scene.cast_fan({}, {}, {});
}

TEST_P(SceneOf, NothingIsEmpty) {
  const auto world = make_world();
  EXPECT_FALSE(world->scene().cast({0, 0, 0}, {1, 0, 0}, 100, {}).has_value());
  std::vector<RayHit> hits(7);
  world->scene().cast_fan({Pose::Identity(), 0, 0.1, 7, 10}, {}, hits);
  for (const RayHit& hit : hits) EXPECT_FALSE(hit.hit());
}

TEST_P(SceneOf, ThingsThatComeAndGo) {
  const auto world = make_world();
  std::mt19937 random(3);
  std::vector<int> groups(40, -1);
  for (int k = 0; k < 3000; ++k) {
    // One place in a row for each; only that of the nearest present counts.
    const std::size_t at = random() % groups.size();
    if (groups[at] >= 0) {
      world->remove_group(groups[at]);
      groups[at] = -1;
    } else {
      groups[at] = world->add_group("g" + std::to_string(at));
      world->add_body(groups[at], body("b", {sphere(0.25, 1)}), translation(1.0 + static_cast<double>(at), 0, 0),
                      at % 2 ? Motion::fixed : Motion::free);
      EXPECT_EQ(world->scene().cast({0, 0, 0}, {1, 0, 0}, 1e-3, {}).has_value(), false);  // not closed yet
      world->close_group(groups[at]);
    }
    const auto nearest = std::find_if(groups.begin(), groups.end(), [](int group) { return group >= 0; });
    const auto hit = world->scene().cast({0, 0, 0}, {1, 0, 0}, 100, {});
    ASSERT_EQ(hit.has_value(), nearest != groups.end()) << k;
    if (hit) {
      ASSERT_NEAR(hit->range_m, 0.75 + static_cast<double>(nearest - groups.begin()), 1e-12) << k;
    }
  }
  for (const int group : groups)
    if (group >= 0) world->remove_group(group);
  EXPECT_FALSE(world->scene().cast({0, 0, 0}, {1, 0, 0}, 100, {}).has_value());
}

/// Parts of every shape in a heap, fixed and moving, some close together, some around the sensor.
std::unique_ptr<PhysicsWorld> RayTest::random_scene(std::mt19937& random) const {
  const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  PhysicsConfig config;
  config.gravity_mps2 = 0;
  auto world = make_world(config);
  add_ground(*world, translation(0, 0, -uniform(1, 3)));
  for (int i = 0; i < 80; ++i) {
    std::vector<PartConfig> parts;
    for (unsigned k = 0; k <= random() % 3; ++k) {
      const PartConfig shapes[] = {box({uniform(0.1, 2), uniform(0.1, 4), uniform(0.1, 2)}, 1),
                                   sphere(uniform(0.1, 1), 1),
                                   round(PartShape::capsule, uniform(0.1, 0.5), uniform(0.1, 3), 1),
                                   round(PartShape::cylinder, uniform(0.1, 1), uniform(0.1, 3), 1)};
      parts.push_back(at(shapes[random() % 4], {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)},
                         {uniform(-3, 3), uniform(-1.5, 1.5), uniform(-3, 3)}));
    }
    add(*world, body("b" + std::to_string(i), parts),
        sim::make_pose({uniform(-15, 15), uniform(-15, 15), uniform(-2, 2)}, {uniform(-3, 3), 0, uniform(-3, 3)}),
        i % 2 == 0 ? Motion::fixed : Motion::free);
  }
  return world;
}

TEST_P(Fan, EqualsSingleCastsInRandomScenes) {
  std::mt19937 random(1);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  int count = 0;
  for (int scene = 0; scene < 10; ++scene) {
    const auto world = random_scene(random);
    for (int k = 0; k < 20; ++k) {
      const bool level = k % 2 == 0;
      sim::Fan fan;
      fan.X_WS = sim::make_pose({uniform(-15, 15), uniform(-15, 15), uniform(-1, 1)},
                                {level ? 0 : uniform(-3, 3), level ? 0 : uniform(-1.5, 1.5), uniform(-3, 3)});
      fan.count = 1 + static_cast<int>(random() % 200);
      fan.first_angle_rad = uniform(-4, 4);
      fan.step_rad = uniform(0.001, 2 * pi / fan.count);
      fan.range_max_m = uniform(1, 30);
      const RayFilter filter{~0u, k % 5 == 0 ? static_cast<int>(random() % 80) : -1};
      std::vector<RayHit> hits(fan.count);
      world->scene().cast_fan(fan, filter, hits);
      for (int i = 0; i < fan.count; ++i) {
        const double angle = fan.first_angle_rad + i * fan.step_rad;
        const Vector3d direction = fan.X_WS.linear() * Vector3d(std::cos(angle), std::sin(angle), 0);
        const auto hit = world->scene().cast(fan.X_WS.translation(), direction, fan.range_max_m, filter);
        ASSERT_EQ(hit.has_value(), std::isfinite(hits[i].range_m)) << scene << " " << k << " " << i;
        if (!hit) continue;
        ASSERT_NEAR(hits[i].range_m, hit->range_m, 1e-9) << scene << " " << k << " " << i;
        ++count;
      }
    }
  }
  EXPECT_GT(count, 1000);  // the test saw something
}

TEST_P(Cast, EqualsLookingAtEveryPart) {
  std::mt19937 random(2);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  const auto world = random_scene(random);
  const int parts = static_cast<int>(world->parts().size());
  for (int k = 0; k < 500; ++k) {
    const Vector3d from(uniform(-15, 15), uniform(-15, 15), uniform(-1, 1));
    const Vector3d direction = Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized();
    const auto all = world->scene().cast(from, direction, 40, {});
    // Leaving out any group but that of the hit changes nothing; leaving out that one finds something
    // farther.
    if (!all) continue;
    const int group = world->parts()[all->part].group;
    EXPECT_EQ(world->scene().cast(from, direction, 40, {~0u, (group + 1) % parts})->part, all->part);
    const auto next = world->scene().cast(from, direction, 40, {~0u, group});
    EXPECT_GE(next ? next->range_m : 40, all->range_m);
  }
}

}  // namespace
