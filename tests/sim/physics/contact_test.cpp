// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/sim/physics/gravity.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace small_worlds;

using test::g;

ContactConfig with_friction(double friction) {
  ContactConfig contact;
  contact.friction = friction;
  return contact;
}

/// Acceleration down a slope of a box that starts at rest, in the second half of a second.
double slip_acceleration(double friction, double slope_deg, double azimuth_rad) {
  const auto world = make_world({}, {with_friction(friction)});
  const double slope = sim::degrees_to_radians(slope_deg);
  Pose X_W = Pose::Identity();
  X_W.linear() = sim::rotation_from_rpy({0, slope, azimuth_rad});  // +x runs down the slope
  add_ground(*world, X_W);
  // The box keeps to the world's axes as well as it can: turned about the normal against the slope.
  Pose X_slope_box = sim::make_pose({0, 0, 0.0995}, {0, 0, -azimuth_rad});
  sim::Body& box_body = add(*world, body("box", {box({1, 1, 0.2}, 10)}), X_W * X_slope_box);
  const Vector3d down_W = X_W.linear().col(0);
  for (int i = 0; i < 50; ++i) world->step(i);
  const double v = down_W.dot(box_body.v_WB_W());
  for (int i = 50; i < 100; ++i) world->step(i);
  return (down_W.dot(box_body.v_WB_W()) - v) / 0.5;
}

// closed_forms.csv incline_box: max(0, g (sin a - mu cos a)), for any direction of the slope.
class Incline : public testing::TestWithParam<double> {};

TEST_P(Incline, BoxSlidesAsCoulombSays) {
  EXPECT_NEAR(slip_acceleration(0.5, 20, GetParam()), 0, 0.02);
  EXPECT_NEAR(slip_acceleration(0.5, 30, GetParam()), 0.656920987, 0.02 * 0.656920987);
  EXPECT_NEAR(slip_acceleration(0.5, 35, GetParam()), 1.608294662, 0.02 * 1.608294662);
  EXPECT_NEAR(slip_acceleration(0.2, 15, GetParam()), 0.6436484878, 0.02 * 0.6436484878);
}

TEST_P(Incline, BoxStartsToSlideAtTheAngleOfFriction) {
  // atan(0.5) = 26.565 deg, half a degree either way.
  EXPECT_LT(slip_acceleration(0.5, 26.065, GetParam()), 0.005);
  EXPECT_GT(slip_acceleration(0.5, 27.065, GetParam()), 0.5 * g * (std::sin(0.47237) - 0.5 * std::cos(0.47237)));
}

INSTANTIATE_TEST_SUITE_P(Azimuths, Incline, testing::Values(0.0, 0.3, std::numbers::pi / 4, 1.2, 2.5));

TEST(Contact, PushedBoxStartsToSlideAtCoulombsForceInAnyDirection) {
  for (const double azimuth : {0.0, 0.4, std::numbers::pi / 4}) {
    const auto world = make_world({}, {with_friction(0.5)});
    add_ground(*world);
    sim::Body& crate = add(*world, body("crate", {box({1, 1, 0.2}, 10)}), translation(0, 0, 0.0995));
    const Vector3d direction(std::cos(azimuth), std::sin(azimuth), 0);
    const auto push = [&](double force_N) {
      for (int i = 0; i < 50; ++i) {
        crate.add_force_W(force_N * direction, crate.X_WB() * Vector3d(0, 0, -0.1));
        world->step(i);
      }
      return crate.v_WB_W().dot(direction);
    };
    EXPECT_NEAR(push(0.98 * 0.5 * 10 * g), 0, 1e-3) << azimuth;
    EXPECT_NEAR(push(1.5 * 0.5 * 10 * g), 0.5 * 0.5 * g * 0.5, 0.02) << azimuth;  // 0.5 mu g for 0.5 s
  }
}

TEST(Contact, BallBouncesToAQuarterOfItsHeight) {
  // closed_forms.csv bounce: e^2 h = 0.25 m.  The ball sinks in by up to v h / 2 on average before it turns:
  // 1 mm.
  PhysicsConfig config;
  config.step_s = 0.0005;
  ContactConfig contact;
  contact.restitution = 0.5;
  const auto world = make_world(config, {contact});
  add_ground(*world);
  const sim::Body& ball = add(*world, body("ball", {sphere(0.1, 1)}), translation(0, 0, 1.1));
  double apex = 0;
  bool bounced = false;
  for (int i = 0; i < 1800; ++i) {
    world->step(i);
    bounced = bounced || ball.v_WB_W().z() > 0;
    if (bounced) apex = std::max(apex, ball.X_WB().translation().z() - 0.1);
  }
  EXPECT_NEAR(apex, 0.25, 0.02 * 0.25);
}

TEST(Contact, EachShapeRestsOnThePlane) {
  const auto world = make_world();
  add_ground(*world);
  struct Case {
    PartConfig part;
    double height_m;
  };
  const Case cases[] = {{box({1, 1, 0.4}, 2), 0.2},
                        {sphere(0.3, 2), 0.3},
                        {round(PartShape::cylinder, 0.3, 0.8, 2), 0.4},
                        {at(round(PartShape::capsule, 0.3, 1, 2), {0, 0, 0}, {0, std::numbers::pi / 2, 0}), 0.3}};
  std::vector<sim::Body*> bodies;
  for (const Case& c : cases)
    bodies.push_back(&add(*world, body("b" + std::to_string(bodies.size()), {c.part}),
                          translation(5.0 * static_cast<double>(bodies.size()), 0, c.height_m + 0.01)));
  for (int i = 0; i < 300; ++i) world->step(i);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    // At rest a body sinks in by the surface layer of 0.5 mm.
    EXPECT_NEAR(bodies[i]->X_WB().translation().z(), cases[i].height_m - 0.0005, 2e-4) << i;
    EXPECT_LT(bodies[i]->v_WB_W().norm(), 1e-3) << i;
  }
}

TEST(Contact, FrictionlessBoxKeepsItsSpeed) {
  const auto world = make_world({}, {with_friction(0)});
  add_ground(*world);
  sim::Body& puck = add(*world, body("puck", {box({1, 1, 0.2}, 2)}), translation(0, 0, 0.0995));
  puck.set_velocity_W({3, 0, 0}, Vector3d::Zero());
  for (int i = 0; i < 100; ++i) world->step(i);
  EXPECT_NEAR(puck.v_WB_W().x(), 3, 1e-9);
}

TEST(Contact, RollingFrictionStopsABall) {
  ContactConfig contact;
  contact.rolling_friction_m = 0.01;
  const auto world = make_world({}, {contact});
  add_ground(*world);
  sim::Body& ball = add(*world, body("ball", {sphere(0.1, 1)}), translation(0, 0, 0.0995));
  ball.set_velocity_W({1, 0, 0}, {0, 10, 0});
  for (int i = 0; i < 50; ++i) world->step(i);
  // Torque rho m g against the inertia of rolling, 7/5 m r^2: a = rho g / (1.4 r) = 0.7 m/s2.
  EXPECT_NEAR(ball.v_WB_W().x(), 1 - 0.5 * 0.01 * g / (1.4 * 0.1), 0.01);
}

TEST(Contact, EntryThatNamesBothMaterialsWinsAndAmongEqualsTheLast) {
  MaterialConfig ice{"ice"}, rubber{"rubber"};
  ContactConfig all = with_friction(1), ice_any = with_friction(0), ice_rubber = with_friction(0.25),
                old_ice_rubber = with_friction(0.9);
  ice_any.between = {"ice", "any"};
  ice_rubber.between = old_ice_rubber.between = {"rubber", "ice"};
  PhysicsWorld world({}, {ice, rubber}, {old_ice_rubber, ice_rubber, ice_any, all}, {}, 1);
  PartConfig ground = plane();
  ground.material = "ice";
  add(world, body("ground", {ground}), Pose::Identity(), Motion::fixed);
  PartConfig rubber_box = box({1, 1, 0.2}, 2), plain_box = rubber_box;
  rubber_box.material = "rubber";
  sim::Body& on_rubber = add(world, body("on_rubber", {rubber_box}), translation(0, 0, 0.0995));
  sim::Body& plain = add(world, body("plain", {plain_box}), translation(0, 9, 0.0995));
  for (sim::Body* puck : {&on_rubber, &plain}) puck->set_velocity_W({3, 0, 0}, Vector3d::Zero());
  for (int i = 0; i < 50; ++i) world.step(i);
  EXPECT_NEAR(plain.v_WB_W().x(), 3, 1e-9);
  EXPECT_NEAR(on_rubber.v_WB_W().x(), 3 - 0.25 * g * 0.5, 0.03);
}

TEST(Categories, BothPartsMustWantTheContact) {
  PhysicsWorld world({}, {}, {}, {"ghost", "floor"}, 1);
  EXPECT_EQ(world.category_bit("solid"), 1u);
  EXPECT_EQ(world.category_bit("floor"), 4u);
  EXPECT_THROW(world.category_bit("wall"), std::out_of_range);
  PartConfig ground = plane();
  ground.category = "floor";
  add(world, body("ground", {ground}), Pose::Identity(), Motion::fixed);
  PartConfig picky = sphere(0.1, 1), easy = sphere(0.1, 1);
  picky.collides_with = {"ghost"};
  const sim::Body& falls = add(world, body("falls", {picky}), translation(0, 0, 0.2));
  const sim::Body& stands = add(world, body("stands", {easy}), translation(1, 0, 0.2));
  // Two in one place: `picky` does not want `solid`.
  const sim::Body& through = add(world, body("through", {easy}), translation(0, 0, 0.2));
  for (int i = 0; i < 100; ++i) world.step(i);
  EXPECT_LT(falls.X_WB().translation().z(), -1);
  EXPECT_NEAR(stands.X_WB().translation().z(), 0.1, 1e-3);
  EXPECT_NEAR(through.X_WB().translation().z(), 0.1, 1e-3);
}

TEST(Groups, PartsOfAGroupCollideOnlyWhenAsked) {
  for (const bool self_collision : {false, true}) {
    const auto world = make_world();
    const int group = world->add_group("twins", self_collision);
    world->add_body(group, body("a", {sphere(0.5, 1)}), Pose::Identity());
    world->add_body(group, body("b", {sphere(0.5, 1)}, {0.5, 0, 0}), Pose::Identity());
    world->close_group(group);
    world->step(0);
    EXPECT_EQ(world->last_step().contacts, self_collision ? 1 : 0);
  }
}

TEST(StepCounts, CountsContactsAndRowsOfTheLargestIsland) {
  const auto world = make_world({}, {slippery()});
  add_ground(*world);
  add_rover(*world, "a", Pose::Identity());
  add_rover(*world, "b", translation(5, 0, 0));
  for (int i = 0; i < 100; ++i) world->step(i);
  // A rover: two wheels and the caster touch; two hinges of 6 rows at most, two contacts of 3 rows, one of 1.
  EXPECT_EQ(world->last_step().contacts, 6);
  EXPECT_EQ(world->last_step().max_island_rows, 2 * 6 + 2 * 3 + 1);
  EXPECT_FALSE(world->last_step().quick);
}

}  // namespace
