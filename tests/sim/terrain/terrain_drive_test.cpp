// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "sim/scene/scene.hpp"
#include "tests/sim/terrain/terrain_worlds.hpp"
#include "tests/state_hash_of.hpp"

namespace {

using namespace terrain_worlds;

constexpr double amplitude_m = 0.1, wavelength_m = 4, speed_mps = 1;

std::unique_ptr<PhysicsWorld> world_of(double step_s) {
  PhysicsConfig config;
  config.step_s = step_s;
  return make_world(config, {slippery()});
}

/// Root mean square of the vertical acceleration of a rover's axle, over waves at 1 m/s, from velocity to velocity of
/// the steps, as an IMU without a filter has it.
double vertical_rms_mps2(TerrainCollision collision, double cell_m, const PartConfig& wheel) {
  constexpr double step_s = 0.005;
  const auto world = world_of(step_s);
  add_terrain(*world, waves(cell_m, collision, amplitude_m, wavelength_m));
  // In a trough, where the ground is level.
  Rover rover = add_rover(*world, "rover", translation(-25, 0, -amplitude_m), wheel);
  for (sim::Joint* motor : {rover.left, rover.right}) motor->set_motor(speed_mps / Rover::wheel_radius_m, 20);
  double before = 0, sum = 0;
  int count = 0;
  for (int step = 0; step < 6000; ++step) {
    world->step(step);
    const double velocity = rover.chassis->velocity_at_W({0, 0, -0.05}).z();
    // Eight whole waves after it gathered way and was pulled to the surface layer.
    if (step >= 800 && step < 800 + 8 * wavelength_m / speed_mps / step_s && step < 5600) {
      sum += std::pow((velocity - before) / step_s, 2);
      ++count;
    }
    before = velocity;
  }
  EXPECT_GT(rover.chassis->X_WB().translation().x(), 2) << "it did not get along";
  return std::sqrt(sum / count);
}

const double closed_form_mps2 =
    std::pow(speed_mps * 2 * std::numbers::pi / wavelength_m, 2) * amplitude_m / std::numbers::sqrt2;

// The wheel goes 1 m/s along the slope, not along x, which takes 1.2 % off v^2; its center follows a parallel of the
// sine, whose bend is up to r k^2 A = 2.5 % off at crests and troughs, with both signs; the B-spline takes 0.3 % off A.
constexpr double sine_tolerance = 0.04;

TEST(TerrainDrive, SphereWheelsOnSmoothWavesDoNotRing) {
  const double rms = vertical_rms_mps2(TerrainCollision::smooth, 0.1, sphere(0.1, 0.5));
  RecordProperty("rms_mps2", std::to_string(rms));
  EXPECT_NEAR(rms, closed_form_mps2, sine_tolerance * closed_form_mps2);
}

TEST(TerrainDrive, CylinderWheelsOnSmoothWavesDoNotRing) {
  const double rms = vertical_rms_mps2(TerrainCollision::smooth, 0.1, cylinder_wheel());
  RecordProperty("rms_mps2", std::to_string(rms));
  EXPECT_NEAR(rms, closed_form_mps2, sine_tolerance * closed_form_mps2);
}

TEST(TerrainDrive, FacetsRingSeveralTimesAsMuch) {
  for (const TerrainCollision collision : {TerrainCollision::facets, TerrainCollision::mesh}) {
    const std::string word(word_of(sim::terrain_collision_words, collision));
    const double of_spheres = vertical_rms_mps2(collision, 0.25, sphere(0.1, 0.5));
    const double of_cylinders = vertical_rms_mps2(collision, 0.25, cylinder_wheel());
    RecordProperty(word + "_sphere_mps2", std::to_string(of_spheres));
    RecordProperty(word + "_cylinder_mps2", std::to_string(of_cylinders));
    EXPECT_GT(of_spheres, 3 * closed_form_mps2) << word;
    EXPECT_GT(of_cylinders, 3 * closed_form_mps2) << word;
  }
}

TEST(TerrainDrive, LevelGroundIsAPlane) {
  for (const PartConfig& wheel : {sphere(0.1, 0.5), cylinder_wheel()}) {
    const auto world = world_of(0.01);
    add_terrain(*world, waves(0.1, TerrainCollision::smooth, 0, 4));
    Rover rover = add_rover(*world, "rover", translation(-30, 0, 0), wheel);
    for (sim::Joint* motor : {rover.left, rover.right}) motor->set_motor(10, 20);
    double fastest = 0;
    for (int step = 0; step < 3000; ++step) {
      world->step(step);
      if (step > 1000) fastest = std::max(fastest, std::abs(rover.chassis->v_WB_W().z()));
    }
    EXPECT_LT(fastest, 1e-9);
    EXPECT_NEAR(rover.chassis->X_WB().translation().y(), 0, 1e-6);
    EXPECT_GT(rover.chassis->X_WB().translation().x(), -2);
  }
}

TEST(TerrainDrive, ABallRollsDownASlopeAsTheTextbookSays) {
  const double angle = 0.2, step_s = 0.002;
  const auto world = world_of(step_s);
  PartConfig ground = level_ground(0.25);
  ground.terrain->angle_rad = angle;
  add_terrain(*world, ground);
  const Vector3d normal(-std::sin(angle), 0, std::cos(angle));
  const Vector3d start = Vector3d(5, 0, 5 * std::tan(angle)) + (0.1 - 0.0005) * normal;
  const sim::Body& ball = add(*world, body("ball", {sphere(0.1, 1)}), sim::make_pose(start, Vector3d::Zero()));
  constexpr int steps = 1000;
  for (int step = 0; step < steps; ++step) world->step(step);
  // A solid ball that rolls: a = 5/7 g sin(angle).
  const double path_m = (ball.X_WB().translation() - start).norm();
  const double t = steps * step_s;
  EXPECT_NEAR(path_m, 5.0 / 14 * 9.80665 * std::sin(angle) * t * t, 0.01 * path_m);
  EXPECT_NEAR((ball.X_WB().translation() - start).dot(normal), 0, 1e-3);
}

/// How far a box slides in 2 s on a slope of 20 degrees, half of which is ice.
double slide_m(double y, double ice_friction) {
  const double angle = sim::degrees_to_radians(20);
  ContactConfig on_ice;
  on_ice.between = {"any", "ice"};
  on_ice.friction = ice_friction;
  ContactConfig on_rock;
  on_rock.friction = std::tan(angle) + 0.05;
  PhysicsWorld world({}, {{"ice"}}, {on_rock, on_ice}, {}, 1);
  PartConfig ground = level_ground(0.5);
  ground.terrain->angle_rad = angle;
  ground.terrain->areas.resize(1);
  ground.terrain->areas[0].material = "ice";
  ground.terrain->areas[0].center_m = {0, 5, 0};
  ground.terrain->areas[0].size_m = {20, 10, 0};
  add_terrain(world, ground);
  const Vector3d normal(-std::sin(angle), 0, std::cos(angle));
  const Vector3d start = Vector3d(3, y, 3 * std::tan(angle)) + 0.2495 * normal;
  const sim::Body& crate = add(world, body("crate", {box({1, 1, 0.5}, 20)}), sim::make_pose(start, {0, -angle, 0}));
  for (int step = 0; step < 200; ++step) world.step(step);
  return (crate.X_WB().translation() - start).norm();
}

TEST(TerrainDrive, FrictionIsThatOfTheAreaAndFollowsTheRuleOfTheTangent) {
  const double angle = sim::degrees_to_radians(20), g = 9.80665;
  EXPECT_LT(slide_m(-5, 0.05), 0.01);                   // beside the ice
  EXPECT_LT(slide_m(5, std::tan(angle) + 0.02), 0.01);  // rough ice
  const double mu = std::tan(angle) - 0.05;
  const double expected_m = g * (std::sin(angle) - mu * std::cos(angle)) * 2;  // a t^2 / 2
  EXPECT_NEAR(slide_m(5, mu), expected_m, 0.03 * expected_m);
}

TEST(TerrainDrive, RaysSeeTheMaterialOfTheArea) {
  PhysicsWorld world({}, {{"ice"}}, {}, {}, 1);
  PartConfig ground = level_ground(1);
  ground.terrain->areas.resize(1);
  ground.terrain->areas[0].material = "ice";
  ground.terrain->areas[0].center_m = {0, 5, 0};
  ground.terrain->areas[0].size_m = {20, 10, 0};
  add_terrain(world, ground, sim::make_pose({100, 0, 3}, {0, 0, std::numbers::pi / 2}));
  const auto material_at = [&](double x, double y) {
    const auto hit = world.scene().cast({x, y, 10}, -Vector3d::UnitZ(), 20, {});
    EXPECT_TRUE(hit.has_value());
    EXPECT_NEAR(hit->range_m, 7, 1e-5);
    EXPECT_TRUE(hit->normal_W.isApprox(Vector3d::UnitZ(), 1e-6));
    return world.material(hit->material).name;
  };
  // Turned by 90 degrees its +y looks to -x.
  EXPECT_EQ(material_at(94.3, 1.2), "ice");
  EXPECT_EQ(material_at(104.3, 1.2), "default");
  EXPECT_FALSE(world.scene().cast({111, 0, 10}, -Vector3d::UnitZ(), 20, {}).has_value());
}

TEST(TerrainDrive, NothingFallsThroughAtTheBordersOfCells) {
  for (const TerrainCollision collision : {TerrainCollision::smooth, TerrainCollision::facets}) {
    const auto world = world_of(0.005);
    PartConfig ground = level_ground(0.5, collision);
    ground.terrain->source = TerrainSource::fractal;
    ground.terrain->wavelength_m = 8;
    ground.terrain->amplitude_m = 0.4;
    add_terrain(*world, ground);
    std::vector<sim::Body*> balls;
    for (int i = 0; i < 12; ++i)
      balls.push_back(&add(*world, body("ball" + std::to_string(i), {sphere(0.1, 1)}),
                           translation(-3 + 0.5 * i, 0.5 * (i % 4), 0.7)));
    for (int step = 0; step < 1000; ++step) world->step(step);
    for (const sim::Body* ball : balls)
      EXPECT_GT(ball->X_WB().translation().z(), -0.5) << word_of(sim::terrain_collision_words, collision);
  }
}

TEST(TerrainDrive, TheSameRunTwice) {
  const auto hash = [] {
    const auto world = world_of(0.005);
    PartConfig ground = level_ground(0.25);
    ground.terrain->source = TerrainSource::fractal;
    add_terrain(*world, ground);
    for (int i = 0; i < 5; ++i)
      add(*world, body("box" + std::to_string(i), {box({0.6, 0.4, 0.3}, 5)}), translation(i - 2, 0, 2));
    for (int step = 0; step < 300; ++step) world->step(step);
    return test::state_hash_of(*world);
  };
  EXPECT_EQ(hash(), hash());
}

TEST(TerrainDrive, TerrainComesAndGoes) {
  const auto world = world_of(0.01);
  sim::Body& hill = add_terrain(*world, level_ground(0.5, TerrainCollision::facets));
  sim::Body& ball = add(*world, body("ball", {sphere(0.1, 1)}), translation(0, 0, 0.0995));
  world->step(0);
  EXPECT_EQ(world->last_step().contacts, 1);
  world->remove_group(hill.group());
  world->step(1);
  EXPECT_EQ(world->last_step().contacts, 0);
  add_terrain(*world, level_ground(0.5), ball.X_WB() * translation(0, 0, -0.0995));
  world->step(2);
  EXPECT_EQ(world->last_step().contacts, 1);
}

TEST(GroundCheck, WarnsOfPairsThatAreKnownToBeBad) {
  const auto warnings = [](const PartConfig& ground, const PartConfig& wheel,
                           const std::vector<ContactConfig>& contacts, const Vector3d& chassis = {0.5, 0.3, 0.1}) {
    PhysicsWorld world({}, {{"slippery"}}, contacts, {}, 1);
    add_terrain(world, ground);
    add_rover(world, "rover", translation(0, 0, 0), wheel);
    add_rover(world, "rover2", translation(0, 3, 0), wheel);
    add(world, body("slab", {box(chassis, 5)}), translation(5, 0, 2));
    std::string all;
    for (const std::string& line : world.ground_warnings()) all += line + "\n";
    return all;
  };
  ContactConfig soft;
  soft.soft_cfm = 1e-3;
  const PartConfig ball = sphere(0.1, 0.5), cylinder = cylinder_wheel();
  EXPECT_EQ(warnings(level_ground(0.1), ball, {}), "");
  EXPECT_EQ(warnings(level_ground(0.1), cylinder, {}), "");
  EXPECT_EQ(
      warnings(level_ground(0.02), cylinder, {}),
      "terrain 'hill/hill/1' under 'rover/left_wheel/1' and 3 more: cells of 0.02 m are much smaller than a wheel of "
      "radius 0.1 m, which touches the ground at one point: bumps may be missed\n");
  EXPECT_EQ(warnings(level_ground(0.1, TerrainCollision::facets), ball, {soft}),
            "terrain 'hill/hill/1' under 'rover/left_wheel/1' and 3 more: facets of 0.1 m are smaller than a wheel of "
            "0.2 m, which costs their square: use collision: smooth\n");
  EXPECT_EQ(warnings(level_ground(0.25, TerrainCollision::facets), ball, {}),
            "terrain 'hill/hill/1' under 'rover/left_wheel/1' and 3 more: hard contacts of a wheel jump from facet to "
            "facet, and accelerations ring: use collision: smooth, or give the contact a soft_cfm\n");
  EXPECT_EQ(warnings(level_ground(0.25, TerrainCollision::facets), ball, {soft}, {4, 2, 0.5}),
            "terrain 'hill/hill/1' under 'slab/slab/1': a box of 4 m covers many facets of 0.25 m, which costs their "
            "square: use collision: smooth\n");
  EXPECT_EQ(warnings(level_ground(0.25, TerrainCollision::mesh), ball, {}), "");
  EXPECT_EQ(warnings(level_ground(0.25, TerrainCollision::mesh), cylinder, {}),
            "terrain 'hill/hill/1' under 'rover/left_wheel/1' and 3 more: a cylinder wheel on triangles has a dozen "
            "contacts, and jitters: use collision: smooth, or a sphere as wheel\n");
}

}  // namespace
