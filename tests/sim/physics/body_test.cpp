// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sim/physics/gravity.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace small_worlds;
using sim::Matrix3d;

using std::numbers::pi;
using test::g;

TEST(Body, FallsLikeAStone) {
  const auto world = make_world(with_step(0.001));
  const sim::Body& stone = add(*world, body("stone", {sphere(0.1, 2)}), translation(0, 0, 100));
  run_for(*world, 2);
  const double t = 2;
  // The step is exact for constant g; the rounding of 2000 sums.
  EXPECT_NEAR(stone.X_WB().translation().z(), 100 - g * t * t / 2, 1e-10);
  // closed_forms.csv free_fall, which has four decimals.
  EXPECT_NEAR(stone.X_WB().translation().z(), 80.3867, 5e-5);
}

TEST(Body, FliesLikeAProjectile) {
  const auto world = make_world(with_step(0.001));
  sim::Body& ball = add(*world, body("ball", {sphere(0.1, 2)}), Pose::Identity());
  const double elevation = sim::degrees_to_radians(40);
  ball.set_velocity_W(12 * Vector3d(std::cos(elevation), 0, std::sin(elevation)), Vector3d::Zero());
  run_for(*world, 1.2);
  EXPECT_NEAR(ball.X_WB().translation().x(), 11.03103998, 1e-4);             // 12 cos(40 deg) 1.2
  EXPECT_NEAR(ball.X_WB().translation().z(), 2.195353579, g * 0.001 * 1.2);  // 12 sin(40 deg) t - g t^2 / 2
}

TEST(Body, ForceThroughTheCenterOfMassDoesNotTurnIt) {
  const auto world = make_world(with_step(0.01, 0));
  sim::Body& hull = add(*world, body("hull", {at(box({1, 1, 1}, 4), {0.5, 0, 0})}), translation(1, 2, 3));
  EXPECT_EQ(hull.p_BC(), Vector3d(0.5, 0, 0));
  hull.add_force_W({0, 8, 0}, {1.5, 2, 3});
  world->step(0);
  EXPECT_NEAR(hull.v_WB_W().y(), 8.0 / 4 * 0.01, 1e-15);
  EXPECT_EQ(hull.w_WB_W(), Vector3d(0, 0, 0));
}

TEST(Body, ForceBesideTheCenterOfMassTurnsIt) {
  const auto world = make_world(with_step(0.01, 0));
  sim::Body& cube = add(*world, body("cube", {box({1, 1, 1}, 6)}), Pose::Identity());
  cube.add_force_W({0, 1, 0}, {0.5, 0, 0});
  world->step(0);
  EXPECT_NEAR(cube.w_WB_W().z(), 0.5 * 1 / (6.0 / 6) * 0.01, 1e-15);  // I = m a^2 / 6
}

TEST(Body, PublishesOfItsOwnFrameNotOfTheCenterOfMass) {
  const auto world = make_world(with_step(0.01, 0));
  sim::Body& hull = add(*world, body("hull", {at(box({1, 1, 1}, 4), {0.5, 0, 0.25})}), Pose::Identity());
  const Pose X_WB = sim::make_pose({1, 2, 3}, {0.1, 0.2, 0.3});
  hull.set_pose(X_WB);
  EXPECT_TRUE(hull.X_WB().isApprox(X_WB, 1e-15));
  hull.set_velocity_W({1, 0, 0}, {0, 0, 2});
  EXPECT_TRUE(hull.v_WB_W().isApprox(Vector3d(1, 0, 0), 1e-15));
  // v + w x r for the point at +y of the body.
  const Vector3d r_W = X_WB.linear() * Vector3d(0, 1, 0);
  EXPECT_TRUE(hull.velocity_at_W({0, 1, 0}).isApprox(Vector3d(1, 0, 0) + Vector3d(0, 0, 2).cross(r_W), 1e-14));
}

TEST(Body, FixedBodyKeepsItsPlace) {
  const auto world = make_world();
  sim::Body& rock = add(*world, body("rock", {box({1, 1, 1}, 0)}), translation(0, 0, 5), Motion::fixed);
  rock.add_force_W({0, 0, 1e6}, {0, 0, 5});
  run_for(*world, 0.1);
  EXPECT_TRUE(rock.fixed());
  EXPECT_EQ(rock.X_WB().translation(), Vector3d(0, 0, 5));
  EXPECT_EQ(rock.v_WB_W(), Vector3d(0, 0, 0));
}

struct ShapeCase {
  PartConfig part;
  double volume_m3;
  Vector3d inertia_per_kg;  // about the center, principal axes
};

class ShapeMass : public testing::TestWithParam<ShapeCase> {};

TEST_P(ShapeMass, IsTheClosedForm) {
  const auto world = make_world();
  PartConfig part = GetParam().part;
  part.mass_kg.reset();
  part.density_kgpm3 = 1000;
  const sim::Body& by_density = add(*world, body("by_density", {part}), Pose::Identity());
  EXPECT_NEAR(by_density.mass_kg(), 1000 * GetParam().volume_m3, 1e-12 * by_density.mass_kg());
  part.density_kgpm3.reset();
  part.mass_kg = 3;
  const sim::Body& by_mass = add(*world, body("by_mass", {part}), Pose::Identity());
  EXPECT_NEAR(by_mass.mass_kg(), 3, 1e-14);
  const Matrix3d expected = (3 * GetParam().inertia_per_kg).asDiagonal();
  EXPECT_TRUE(by_mass.inertia_C_B().isApprox(expected, 1e-12)) << by_mass.inertia_C_B();
}

/// Cylinder plus two half spheres, whose centers of mass lie 3/8 r from their flat sides.
ShapeCase capsule_case(double r, double l) {
  const double v_cylinder = pi * r * r * l, v_caps = 4 * pi * r * r * r / 3, v = v_cylinder + v_caps;
  const double along = (v_cylinder * r * r / 2 + v_caps * 2 * r * r / 5) / v;
  const double across =
      (v_cylinder * (r * r / 4 + l * l / 12) + v_caps * (2 * r * r / 5 + l * l / 4 + 3 * l * r / 8)) / v;
  return {round(PartShape::capsule, r, l, 1), v, {across, across, along}};
}

INSTANTIATE_TEST_SUITE_P(Shapes, ShapeMass,
                         testing::Values(ShapeCase{box({1, 2, 3}, 1), 6, {13.0 / 12, 10.0 / 12, 5.0 / 12}},
                                         ShapeCase{sphere(0.5, 1), pi / 6, {0.1, 0.1, 0.1}},  // 2/5 r^2
                                         ShapeCase{round(PartShape::cylinder, 0.5, 2, 1),
                                                   pi / 2,
                                                   {0.25 / 4 + 4.0 / 12, 0.25 / 4 + 4.0 / 12, 0.125}},
                                         capsule_case(0.5, 2)));

TEST(CompositeBody, AddsMassesCentersAndInertias) {
  const auto world = make_world();
  // Two cubes of side 1 and masses 1 and 3, 4 m apart along x: center at 3/4 of the way.
  const sim::Body& dumb_bell =
      add(*world, body("dumb_bell", {box({1, 1, 1}, 1), at(box({1, 1, 1}, 3), {4, 0, 0})}), Pose::Identity());
  EXPECT_NEAR(dumb_bell.mass_kg(), 4, 1e-14);
  EXPECT_TRUE(dumb_bell.p_BC().isApprox(Vector3d(3, 0, 0), 1e-14));
  // Steiner: m1 m2 / (m1 + m2) d^2 = 3/4 16 = 12 across, on top of m / 6 each.
  EXPECT_TRUE(
      dumb_bell.inertia_C_B().isApprox(Matrix3d(Vector3d(4.0 / 6, 12 + 4.0 / 6, 12 + 4.0 / 6).asDiagonal()), 1e-13));
}

TEST(CompositeBody, TurnsTheInertiaOfATurnedPart) {
  const auto world = make_world();
  const sim::Body& plank =
      add(*world, body("plank", {at(box({1, 2, 3}, 12), {0, 0, 0}, {0, 0, pi / 2})}), Pose::Identity());
  EXPECT_TRUE(plank.inertia_C_B().isApprox(Matrix3d(Vector3d(10, 13, 5).asDiagonal()), 1e-13));
}

TEST(CompositeBody, WeightlessPartAddsNothing) {
  const auto world = make_world();
  const sim::Body& buoy =
      add(*world, body("buoy", {sphere(0.5, 2), at(box({1, 1, 1}, 0), {5, 0, 0})}), Pose::Identity());
  EXPECT_NEAR(buoy.mass_kg(), 2, 1e-15);
  EXPECT_EQ(buoy.p_BC(), Vector3d(0, 0, 0));
}

TEST(CompositeBody, WithoutMassIsAConfigError) {
  const auto world = make_world();
  const int group = world->add_group("ghost");
  PartConfig part = box({1, 1, 1}, 0);
  part.place = {sim::intern_file_name("ghost.yaml"), 3, 5};
  try {
    world->add_body(group, body("hull", {part}), Pose::Identity());
    FAIL();
  } catch (const sim::ConfigError& error) {
    EXPECT_STREQ(error.what(), "ghost.yaml:3:5: body 'ghost/hull': has no mass: give a part mass_kg or density_kgpm3");
  }
}

TEST(CompositeBody, PlaneInAMovingBodyIsAConfigError) {
  const auto world = make_world();
  const int group = world->add_group("ghost");
  EXPECT_THROW(world->add_body(group, body("hull", {plane()}), Pose::Identity()), sim::ConfigError);
}

TEST(Gyroscopic, SymmetricBodyPrecessesAtTheEulerRate) {
  // closed_forms.csv torque_free_symmetric_body: (I_axial - I_transverse) / I_transverse * 6 rad/s = 4.5
  // rad/s. A cylinder with these inertias: m = 2 I_a / r^2 and I_t = m (3 r^2 + l^2) / 12.
  const double r = 0.5, axial = 0.35, transverse = 0.2, m = 2 * axial / (r * r);
  const double l = std::sqrt(12 * transverse / m - 3 * r * r);
  const auto world = make_world(with_step(0.001, 0));
  sim::Body& top = add(*world, body("top", {round(PartShape::cylinder, r, l, m)}), Pose::Identity());
  EXPECT_NEAR(top.inertia_C_B()(2, 2), axial, 1e-12);
  EXPECT_NEAR(top.inertia_C_B()(0, 0), transverse, 1e-12);
  top.set_velocity_W(Vector3d::Zero(), {0.5, 0, 6});
  double angle = 0;
  Vector3d last = {0.5, 0, 6};
  for (int i = 0; i < 2000; ++i) {
    world->step(i);
    const Vector3d w_B = top.X_WB().linear().transpose() * top.w_WB_W();
    angle += std::atan2(last.x() * w_B.y() - last.y() * w_B.x(), last.x() * w_B.x() + last.y() * w_B.y());
    last = w_B;
  }
  EXPECT_NEAR(angle / 2, 4.5, 0.045);
}

TEST(Gyroscopic, TumblingBodyKeepsItsEnergyAndMomentum) {
  const auto world = make_world(with_step(0.01, 0));
  sim::Body& brick = add(*world, body("brick", {box({0.1, 0.4, 1}, 5)}), Pose::Identity());
  brick.set_velocity_W(Vector3d::Zero(), {1, 10, 1});  // about the middle axis: it tumbles
  const Matrix3d& I = brick.inertia_C_B();
  const auto momentum = [&]() -> Vector3d { return I * (brick.X_WB().linear().transpose() * brick.w_WB_W()); };
  const auto energy = [&] { return momentum().dot(brick.X_WB().linear().transpose() * brick.w_WB_W()) / 2; };
  const double momentum0 = momentum().norm(), energy0 = energy();
  run_for(*world, 10);
  // The midpoint rule keeps both; 1000 steps of rounding.
  EXPECT_NEAR(energy() / energy0, 1, 1e-12);
  EXPECT_NEAR(momentum().norm() / momentum0, 1, 1e-12);
}

TEST(Body, WithoutGravityStaysWhereItIs) {
  const auto world = make_world();
  sim::Body& balloon = add(*world, body("balloon", {sphere(1, 1)}), translation(0, 0, 3));
  balloon.set_gravity(false);
  run_for(*world, 1);
  EXPECT_EQ(balloon.X_WB().translation(), Vector3d(0, 0, 3));
}

}  // namespace
