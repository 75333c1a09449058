// SPDX-License-Identifier: BSD-3-Clause
// Groups that are far from everything are not looked at by the collision search, and single bodies that touch nothing
// are not stepped by ODE.  Neither may matter to what they meet, or to what rays see.
#include "sim/physics/far_groups.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>

#include "tests/sim/physics/small_worlds.hpp"
#include "tests/sim/physics/step_objects.hpp"
#include "tests/state_hash_of.hpp"

namespace {

using namespace small_worlds;

PhysicsConfig far_from_planets() {
  return with_step(0.01, 0);
}

sim::Body& add_ball(PhysicsWorld& world, const std::string& name, double x_m, double v_x_mps) {
  sim::Body& ball = add(world, body(name, {sphere(0.5, 1)}), translation(x_m, 0, 0));
  ball.set_velocity_W({v_x_mps, 0, 0}, Vector3d::Zero());
  return ball;
}

/// Returns the number of the first step with a contact; -1: none.
int first_contact(PhysicsWorld& world, int steps) {
  for (int i = 0; i < steps; ++i) {
    world.step(i);
    if (world.last_step().contacts > 0) return i;
  }
  return -1;
}

TEST(FarGroups, AreOutOfTheCollisionSpaceWhileTheirBoxesMeetNothing) {
  StepObjects objects(far_from_planets());
  objects.add_ball("a", 0);
  sim::SteppedBody& b = objects.add_ball("b", 100);
  objects.far_groups.update();
  EXPECT_TRUE(objects.far_groups.far(0));
  EXPECT_TRUE(objects.far_groups.far(1));
  b.set_pose(translation(0.9, 0, 0));
  EXPECT_TRUE(objects.collider.find_pairs().empty()) << "they touch, but the space has neither";
  objects.far_groups.update();
  EXPECT_FALSE(objects.far_groups.far(0));
  EXPECT_FALSE(objects.far_groups.far(1));
  EXPECT_EQ(objects.collider.find_pairs().size(), 1u);
}

TEST(FarGroups, TellThatSomethingChangedWhenGroupsComeNear) {
  StepObjects objects(far_from_planets());
  objects.add_ball("a", 0);
  sim::SteppedBody& b = objects.add_ball("b", 100);
  objects.far_groups.update();
  const std::uint64_t before = objects.far_groups.changes();
  b.set_pose(translation(50, 0, 0));
  objects.far_groups.update();
  EXPECT_EQ(objects.far_groups.changes(), before) << "it has a new box, and is as far as before";
  b.set_pose(translation(0.9, 0, 0));
  objects.far_groups.update();
  EXPECT_GT(objects.far_groups.changes(), before);
}

TEST(FarGroups, HaveBoxesWithLeeway) {
  // Balls of 0.5 m that stand have 0.1 m of leeway, and their farthest point is taken for a corner of the box around
  // them: boxes of 0.1 m + 0.5 sqrt(3) m = 0.966 m to each side.
  for (const double gap_m : {1.92, 1.94}) {
    StepObjects objects(far_from_planets());
    objects.add_ball("a", 0);
    objects.add_ball("b", gap_m);
    objects.add_ball("elsewhere", 100);
    objects.far_groups.update();
    EXPECT_EQ(objects.far_groups.far(0), gap_m > 1.93) << gap_m;
  }
}

TEST(FarGroups, AreNotTriedForSomeTimeOnACommonGround) {
  StepObjects objects(far_from_planets());
  objects.add(body("ground", {plane()}), translation(0, 0, -0.5), Motion::fixed);
  sim::SteppedBody& ball = objects.add_ball("ball", 0);
  objects.far_groups.update();
  EXPECT_FALSE(objects.far_groups.far(ball.group()));
  ball.set_pose(translation(0, 0, 1000));
  for (int i = 0; i < 500; ++i) objects.far_groups.update();
  EXPECT_FALSE(objects.far_groups.far(ball.group()));
  ball.set_pose(translation(0, 0, 1001));
  objects.groups.for_each_moving([&](const sim::SteppedBody& body) { objects.far_groups.note(body.group()); });
  objects.far_groups.update();
  EXPECT_TRUE(objects.far_groups.far(ball.group()));
}

TEST(FarGroups, TouchInTheFirstStepThatBeginsWithOverlap) {
  for (const double v : {0.5, 3.0, 40.0}) {
    const std::unique_ptr<PhysicsWorld> world = make_world(far_from_planets());
    add_ball(*world, "waiting", 0, 0);
    add_ball(*world, "coming", -20.251, v);
    // The gap of 19.251 m is closed after 19.251 / v; the step after that has the contact.
    EXPECT_EQ(first_contact(*world, 4200), static_cast<int>(std::ceil(19.251 / v / 0.01))) << v << " m/s";
  }
}

TEST(FarGroups, TouchWhenTheyArePlacedNextToEachOther) {
  const std::unique_ptr<PhysicsWorld> world = make_world(far_from_planets());
  add_ball(*world, "waiting", 0, 0);
  sim::Body& other = add_ball(*world, "other", 100, 0);
  EXPECT_EQ(first_contact(*world, 10), -1);
  world->move_group(other.group(), translation(-99.1, 0, 0));
  EXPECT_EQ(first_contact(*world, 1), 0);
}

TEST(FarGroups, TouchAWallThatIsPlacedNextToThem) {
  const std::unique_ptr<PhysicsWorld> world = make_world(far_from_planets());
  add_ball(*world, "waiting", 0, 0);
  sim::Body& wall = add(*world, body("wall", {box({1, 1, 1}, 0)}), translation(100, 0, 0), Motion::fixed);
  EXPECT_EQ(first_contact(*world, 10), -1);
  wall.set_pose(translation(0.9, 0, 0));
  EXPECT_EQ(first_contact(*world, 1), 0);
}

TEST(FarGroups, TouchWhatIsAddedNextToThem) {
  const std::unique_ptr<PhysicsWorld> world = make_world(far_from_planets());
  add_ball(*world, "waiting", 0, 0);
  EXPECT_EQ(first_contact(*world, 10), -1);
  add_ball(*world, "added", 0.9, 0);
  EXPECT_EQ(first_contact(*world, 1), 0);
}

TEST(FarGroups, AreSeenByRaysWhereTheyAre) {
  for (const auto& [word, library] : sim::ray_library_words) {
    PhysicsConfig config = far_from_planets();
    config.rays = library;
    const std::unique_ptr<PhysicsWorld> world = make_world(config);
    PartConfig nose = at(sphere(0.5, 1), {1, 0, 0});  // beside the center of mass
    sim::Body& flying = add(*world, body("flying", {sphere(0.5, 1), nose}), translation(0, 0, 0));
    flying.set_velocity_W({2, 0, 0}, Vector3d::Zero());
    for (int i = 0; i < 300; ++i) world->step(i);
    // After 3 s at 2 m/s the nose is 7 m ahead; seen from 20 m its surface is at 20 - 7.5.
    const auto hit = world->scene().cast({20, 0, 0}, -Vector3d::UnitX(), 100, {});
    ASSERT_TRUE(hit) << word;
    EXPECT_NEAR(hit->range_m, 12.5, 1e-9) << word;
    // Its box is exact as well: of the first part, from 5.5 to 6.5 m.
    const auto bounds = world->bounds_W(0);
    ASSERT_TRUE(bounds);
    EXPECT_NEAR(bounds->min().x(), 5.5, 1e-9);
    EXPECT_NEAR(bounds->max().x(), 6.5, 1e-9);
  }
}

TEST(FarGroups, DoNotMatterToTheMotionOfOthers) {
  // Two balls that collide, alone and beside a crowd that is near a ground: then nothing is far.
  const auto run = [](bool ground) {
    const std::unique_ptr<PhysicsWorld> world = make_world(far_from_planets());
    sim::Body& a = add_ball(*world, "a", -5, 1);
    sim::Body& b = add_ball(*world, "b", 5, -1.5);
    if (ground) {
      add_ground(*world, translation(0, 0, -100));
      for (int i = 0; i < 40; ++i)
        add(*world, body("stone" + std::to_string(i), {sphere(0.1, 1)}), translation(3 * i, 50, -99.95));
    }
    for (int i = 0; i < 600; ++i) world->step(i);
    EXPECT_NE(a.v_WB_W().x(), 1) << "they did not meet";
    return test::state_hash_of(a) ^ test::state_hash_of(b);
  };
  EXPECT_EQ(run(false), run(true));
}

TEST(FarGroups, OfKinematicBodiesAreWhereTheyWerePlaced) {
  // The pose of a body that moves without ODE has the bits of one that is placed there.
  const std::unique_ptr<PhysicsWorld> world = make_world(far_from_planets());
  sim::Body& moved = add(*world, body("moved", {box({1, 2, 3}, 0)}), translation(0, 0, 0), Motion::kinematic);
  sim::Body& placed = add(*world, body("placed", {box({1, 2, 3}, 0)}), translation(0, 50, 0), Motion::kinematic);
  for (int i = 0; i < 50; ++i) {
    Pose X = sim::make_pose({0.01 * i, 0, 0}, {0.3 * (i / 10), 0.2 * (i / 10), -0.11 * (i / 10)});
    moved.move_to(X, 0.01);
    world->step(i);
    placed.set_pose(X);
    EXPECT_EQ(moved.X_WB().matrix(), placed.X_WB().matrix()) << i;
  }
}

}  // namespace
