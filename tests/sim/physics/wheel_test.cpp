// SPDX-License-Identifier: BSD-3-Clause
// Cylinders on hinges, whose contacts sim/ode/find_contacts.hpp moves.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace small_worlds;

/// Cylinder or capsule along y.
PartConfig across(PartShape shape, double radius_m, double length_m, double mass_kg) {
  return at(round(shape, radius_m, length_m, mass_kg), Vector3d::Zero(), {std::numbers::pi / 2, 0, 0});
}

/// A frame on two drums of 1 m width, one behind the other, with its mass beside the middle.
struct TandemRoller {
  sim::Body* frame;
  sim::Joint* drums[2];
};

TandemRoller add_roller(PhysicsWorld& world, double mass_y_m, const PartConfig& drum, const Pose& X_WV) {
  const int group = world.add_group("roller");
  TandemRoller roller{};
  roller.frame =
      &world.add_body(group, body("frame", {at(box({1, 0.6, 0.2}, 50), {0, mass_y_m, 0})}, {0, 0, 0.7}), X_WV);
  for (const int i : {0, 1}) {
    const Vector3d axle(i == 0 ? 0.8 : -0.8, 0, 0.3);
    sim::Body& drum_body = world.add_body(group, body("drum" + std::to_string(i), {drum}, axle), X_WV);
    roller.drums[i] =
        &world.add_joint(group, joint("axle" + std::to_string(i), JointType::hinge, axle, Vector3d::UnitY()),
                         *roller.frame, &drum_body, X_WV);
  }
  world.close_group(group);
  return roller;
}

double roll_rad(const sim::Body& body) {
  return std::asin(body.X_WB().linear()(2, 1));
}

TEST(Wheel, HasOneContactOnLevelGround) {
  const auto world = make_world();
  add_ground(*world);
  add_rover(*world, "rover", translation(0, 0, 0), across(PartShape::cylinder, 0.1, 0.06, 0.5));
  run_for(*world, 1);
  EXPECT_EQ(world->last_step().contacts, 3) << "two wheels and a caster";
}

TEST(Wheel, HasOneContactAlsoWhenMoreAreNotAllowed) {
  PhysicsConfig config;
  config.max_contacts_per_pair = 1;
  const auto world = make_world(config, {slippery()});
  add_ground(*world);
  Rover rover = add_rover(*world, "rover", translation(0, 0, 0), across(PartShape::cylinder, 0.1, 0.06, 0.5));
  rover.left->set_motor(-2, 20);
  rover.right->set_motor(2, 20);
  run_for(*world, 4);
  // 2 rad/s on 0.1 m, half a track of 0.2 m.
  EXPECT_NEAR(rover.chassis->w_WB_W().z(), 1, 0.02);
}

/// Its mass is far from the middle, and its drums bear on the side to which it tilts: by 0.25 mm in 0.5 m.
TEST(Wheel, ARollerOnTwoDrumsDoesNotTipOver) {
  for (const double mass_y_m : {0.0, 0.2, -0.4}) {
    const auto world = make_world();
    add_ground(*world);
    const TandemRoller roller =
        add_roller(*world, mass_y_m, across(PartShape::cylinder, 0.3, 1, 20), translation(0, 0, 0));
    for (sim::Joint* drum : roller.drums) drum->set_motor(2, 100);
    run_for(*world, 10);
    EXPECT_LT(std::abs(roll_rad(*roller.frame)), 0.002) << mass_y_m;
    EXPECT_NEAR(roller.frame->X_WB().translation().x(), 6, 0.1) << mass_y_m;
    EXPECT_LT(std::abs(roller.frame->v_WB_W().z()), 1e-3) << mass_y_m;
  }
}

/// On a slope across its way of 20 degrees, below that of its friction of 45.
TEST(Wheel, HoldsARollerOnASlopeAcross) {
  const auto world = make_world();
  Pose X_W = Pose::Identity();
  X_W.linear() = sim::rotation_from_rpy({0.35, 0, 0});
  add_ground(*world, X_W);
  const TandemRoller roller = add_roller(*world, 0, across(PartShape::cylinder, 0.3, 1, 20), X_W);
  run_for(*world, 1);
  const Vector3d from = roller.frame->X_WB().translation();
  run_for(*world, 5);
  EXPECT_LT((roller.frame->X_WB().translation() - from).norm(), 0.01);
}

TEST(Wheel, OnARimStandsALittleLower) {
  // A camber of 3 degrees: the rim is lower by 0.25 mm, and sinks in by the surface layer of 0.5 mm.
  const double camber = sim::degrees_to_radians(3);
  const auto world = make_world();
  add_ground(*world);
  const int group = world->add_group("stand");
  const Pose X_WV = sim::make_pose({0, 0, 0.2}, {camber, 0, 0});
  sim::Body& post = world->add_body(group, body("post", {box({0.1, 0.1, 0.1}, 1)}), X_WV);
  sim::Body& wheel = world->add_body(group, body("wheel", {across(PartShape::cylinder, 0.1, 0.06, 1)}), X_WV);
  world->add_joint(group, joint("hinge", JointType::hinge, Vector3d::Zero(), Vector3d::UnitY()), post, &wheel, X_WV);
  JointConfig rail =
      joint("rail", JointType::slider, Vector3d::Zero(), Vector3d(0, std::sin(camber), std::cos(camber)));
  world->add_joint(group, rail, post, nullptr, X_WV);
  world->close_group(group);
  run_for(*world, 3);
  const double lowest_m = wheel.X_WB().translation().z() - 0.1 * std::cos(camber) - 0.03 * std::sin(camber);
  EXPECT_NEAR(lowest_m, -0.0005 - 0.00025, 1e-5);
}

}  // namespace
