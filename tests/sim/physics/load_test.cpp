// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/sim/physics/gravity.hpp"
#include "tests/sim/physics/small_worlds.hpp"
#include "tests/state_hash_of.hpp"

namespace {

using namespace small_worlds;

using test::g;

void run(PhysicsWorld& world, int steps) {
  for (int i = 0; i < steps; ++i) world.step(i);
}

TEST(ContactReport, OfASphereAtRestIsItsWeightWhicheverPartHasTheLowerNumber) {
  for (const bool ground_first : {true, false}) {
    const auto world = make_world();
    if (ground_first) add_ground(*world);
    const sim::Body& ball = add(*world, body("ball", {sphere(0.5, 2)}), translation(1, 2, 0.5));
    if (!ground_first) add_ground(*world);
    world->watch_contacts(ball.group());
    run(*world, 300);
    ASSERT_EQ(world->contacts().size(), 1u);
    const sim::ContactReport& contact = world->contacts()[0];
    EXPECT_EQ(contact.parts[0], 0);
    EXPECT_EQ(contact.parts[1], 1);
    const double up = ground_first ? -1 : 1;  // the ball is parts[1] when the ground was there before it
    EXPECT_TRUE(contact.normal_W.isApprox(up * Vector3d::UnitZ(), 1e-9));
    EXPECT_NEAR(contact.force_W_N.z(), up * 2 * g, 1e-3 * 2 * g);
    EXPECT_NEAR(contact.force_W_N.head<2>().norm(), 0, 1e-3);
    EXPECT_NEAR((contact.position_W - Vector3d(1, 2, 0)).norm(), 0, 0.002);
    EXPECT_GT(contact.depth_m, 0);
    EXPECT_LT(contact.depth_m, 0.002);
  }
}

TEST(ContactReport, OfABoxPressedAgainstAWallIsTheForceOnItAndItsFriction) {
  PhysicsConfig config;
  config.gravity_mps2 = 0;
  const auto world = make_world(config);
  add(*world, body("wall", {box({1, 5, 5}, 0)}), translation(0.5, 0, 0), Motion::fixed);
  sim::Body& crate = add(*world, body("crate", {box({1, 1, 1}, 3)}), translation(-0.5, 0, 0));
  world->watch_contacts(0);
  for (int i = 0; i < 200; ++i) {
    crate.add_force_W({40, 0, -6}, crate.X_WB().translation());
    world->step(i);
  }
  Vector3d on_wall_W_N = Vector3d::Zero();
  for (const sim::ContactReport& contact : world->contacts()) {
    EXPECT_NEAR(contact.normal_W.x(), 1, 1e-6);  // into the wall, out of the crate
    on_wall_W_N += contact.force_W_N;
  }
  EXPECT_NEAR(on_wall_W_N.x(), 40, 0.04);
  EXPECT_NEAR(on_wall_W_N.z(), -6, 0.04);
}

TEST(ContactReport, BetweenTwoBodiesIsEqualAndOpposite) {
  const auto world = make_world();
  add_ground(*world);
  add(*world, body("lower", {box({1, 1, 1}, 5)}), translation(0, 0, 0.5));
  const sim::Body& upper = add(*world, body("upper", {sphere(0.5, 2)}), translation(0, 0, 1.5));
  world->watch_contacts(upper.group());
  run(*world, 300);
  ASSERT_EQ(world->contacts().size(), 1u);
  EXPECT_EQ(world->contacts()[0].parts[0], 1);
  EXPECT_EQ(world->contacts()[0].parts[1], 2);
  EXPECT_NEAR(world->contacts()[0].force_W_N.z(), -2 * g, 1e-3 * 2 * g);
}

TEST(ContactReport, ReportsOnlyOfWatchedGroupsAndCountsTheWatchers) {
  const auto world = make_world();
  add_ground(*world);
  const sim::Body& a = add(*world, body("a", {sphere(0.5, 2)}), translation(0, 0, 0.5));
  add(*world, body("b", {sphere(0.5, 2)}), translation(3, 0, 0.5));
  run(*world, 2);
  EXPECT_TRUE(world->contacts().empty());
  for (int i = 0; i < 2; ++i) world->watch_contacts(a.group());
  run(*world, 2);
  EXPECT_EQ(world->contacts().size(), 1u);
  world->unwatch_contacts(a.group());
  run(*world, 2);
  EXPECT_EQ(world->contacts().size(), 1u);
  for (int i = 0; i < 2; ++i) world->unwatch_contacts(a.group());
  run(*world, 2);
  EXPECT_TRUE(world->contacts().empty());
}

TEST(ContactReport, WatchingAndMeasuringDoNotChangeTheRun) {
  for (const auto& [word, solver] : PhysicsConfig::solver_words) {
    const auto hash = [&, of_solver = solver](bool watch) {
      PhysicsConfig config;
      config.solver = of_solver;
      const auto world = make_world(config, {slippery()});
      add_ground(*world);
      for (int i = 0; i < 20; ++i) {
        const sim::Body& crate =
            add(*world, body("crate" + std::to_string(i), {box({0.4, 0.4, 0.4}, 1)}),
                sim::make_pose({0.05 * i, 0.02 * i * (i % 3), 0.3 + 0.45 * i}, {0.1 * i, 0, 0.2 * i}));
        if (watch) world->watch_contacts(crate.group());
      }
      for (int i = 0; i < 4; ++i) {
        Rover rover = add_rover(*world, "rover" + std::to_string(i), translation(-2, 0.7 * i, 0));
        rover.left->set_motor(5, 5);
        if (watch) rover.left->measure_load();
      }
      run(*world, 300);
      return test::state_hash_of(*world);
    };
    EXPECT_EQ(hash(true), hash(false)) << word;
  }
}

TEST(FindPart, ByBodyAndPart) {
  const auto world = make_world({}, {slippery()});
  add_ground(*world);
  PartConfig hull = box({1, 1, 1}, 1);
  hull.name = "hull";
  const int group = world->add_group("boat");
  world->add_body(group, body("chassis", {sphere(1, 1), hull}), Pose::Identity());
  EXPECT_EQ(world->find_part(group, "chassis/hull"), 2);
  EXPECT_EQ(world->find_part(group, "chassis/1"), 1);
  EXPECT_EQ(world->find_part(group, "chassis"), std::nullopt);
  EXPECT_EQ(world->find_part(group, "hull"), std::nullopt);
  EXPECT_THROW(world->find_part(7, "hull"), std::out_of_range);
}

/// A beam of 2 kg whose center is 0.5 m along x from a joint at the origin, joined to a heavy base or to the world.
struct Arm {
  explicit Arm(JointConfig config, bool to_world, bool base_is_second = false, double gravity_mps2 = g) {
    PhysicsConfig physics;
    physics.gravity_mps2 = gravity_mps2;
    world = make_world(physics);
    const int group = world->add_group("rig");
    const auto motion = to_world ? Motion::fixed : Motion::kinematic;
    base = &world->add_body(group, body("base", {box({0.2, 0.2, 0.2}, 0)}), Pose::Identity(), motion);
    arm = &world->add_body(group, body("arm", {box({1, 0.1, 0.1}, 2)}, {0.5, 0, 0}), Pose::Identity());
    joint = base_is_second ? &world->add_joint(group, config, *arm, base, Pose::Identity())
                           : &world->add_joint(group, config, *base, arm, Pose::Identity());
    world->close_group(group);
    joint->measure_load();
  }
  std::unique_ptr<PhysicsWorld> world;
  sim::Body *base, *arm;
  sim::Joint* joint;
};

TEST(JointLoad, OfAMotorThatHoldsAnArmIsItsWeightTimesTheLever) {
  // About +y the weight pulls the arm towards positive angles: the motor holds with -m g r, r = 0.5 m.
  for (const bool to_world : {true, false}) {
    Arm rig(joint("elbow", JointType::hinge, {0, 0, 0}, Vector3d::UnitY()), to_world);
    rig.joint->set_motor(0, 100);
    run(*rig.world, 100);
    EXPECT_NEAR(rig.joint->effort(), -2 * g * 0.5, 1e-5);
    EXPECT_NEAR((rig.joint->force_W_N() - Vector3d(0, 0, 2 * g)).norm(), 0, 1e-5);
    EXPECT_NEAR((rig.joint->torque_W_Nm() - Vector3d(0, -g, 0)).norm(), 0, 1e-5);
  }
}

TEST(JointLoad, ActsOnTheSecondBodyWhereTwoMove) {
  // Base second: the joint counts the base relative to the arm, and the load is what pulls at the base.
  Arm rig(joint("elbow", JointType::hinge, {0, 0, 0}, Vector3d::UnitY()), false, true);
  rig.joint->set_motor(0, 100);
  run(*rig.world, 100);
  EXPECT_NEAR(rig.joint->effort(), 2 * g * 0.5, 1e-5);
  EXPECT_NEAR(rig.joint->force_W_N().z(), -2 * g, 1e-5);
}

TEST(JointLoad, OfAHangingMassIsItsWeightUpwards) {
  for (const JointType type : {JointType::fixed, JointType::ball}) {
    const auto world = make_world();
    const int group = world->add_group("lamp");
    sim::Body& lamp = world->add_body(group, body("lamp", {sphere(0.1, 2)}, {0, 0, -1}), Pose::Identity());
    sim::Joint& chain = world->add_joint(group, joint("chain", type, {0, 0, 0}), lamp, nullptr, Pose::Identity());
    world->close_group(group);
    EXPECT_EQ(chain.force_W_N(), Vector3d(0, 0, 0));
    chain.measure_load();
    run(*world, 100);
    EXPECT_NEAR((chain.force_W_N() - Vector3d(0, 0, 2 * g)).norm(), 0, 1e-5) << word_of(sim::joint_type_words, type);
    EXPECT_NEAR(chain.torque_W_Nm().norm(), 0, 1e-5) << word_of(sim::joint_type_words, type);
  }
}

TEST(JointLoad, OfAWeldHasTheTorqueAboutTheAnchor) {
  Arm rig(joint("weld", JointType::fixed, {0, 0, 0}), true);
  run(*rig.world, 100);
  EXPECT_NEAR((rig.joint->torque_W_Nm() - Vector3d(0, -g, 0)).norm(), 0, 1e-4);
}

TEST(JointLoad, OfAStopIsCountedAsEffortWithTheMotorThatPushesIntoIt) {
  // The motor pushes with 4 N m towards the high stop at 0.2 rad, without gravity: together they hold nothing.
  for (const bool to_world : {true, false}) {
    JointConfig config = joint("elbow", JointType::hinge, {0, 0, 0}, Vector3d::UnitY());
    config.axis1.low_stop = -1;
    config.axis1.high_stop = 0.2;
    Arm rig(config, to_world, false, 0);
    rig.joint->set_motor(1, 4);
    run(*rig.world, 300);
    EXPECT_NEAR(rig.joint->position(), 0.2, 0.01);
    EXPECT_NEAR(rig.joint->effort(), 0, 1e-3);
    rig.joint->set_motor(0, 0);
    for (int i = 0; i < 300; ++i) {
      rig.arm->add_torque_W({0, 3, 0});  // only the stop holds against it
      rig.world->step(i);
    }
    EXPECT_NEAR(rig.joint->effort(), -3, 1e-3);
  }
}

TEST(JointLoad, OfAMotorThatLeavesAStopIsThatOfTheMotor) {
  for (const bool to_world : {true, false}) {
    // The arm rests on its stop, which it reaches a little softly, and is then lifted from it.
    JointConfig config = joint("elbow", JointType::hinge, {0, 0, 0}, Vector3d::UnitY());
    config.axis1.high_stop = 0;
    Arm rig(config, to_world);
    run(*rig.world, 100);
    EXPECT_NEAR(rig.joint->effort(), -g, 1e-4);
    rig.joint->set_motor(-0.001, 100);
    run(*rig.world, 1);
    // Its inertia about the joint is m (l^2 + w^2) / 12 + m (l / 2)^2.
    const double inertia_kgm2 = 2 * (1 + 0.01) / 12 + 2 * 0.25;
    EXPECT_NEAR(rig.joint->effort(), -g - inertia_kgm2 * 0.001 / 0.01, 1e-3);
    run(*rig.world, 1);
    EXPECT_NEAR(rig.joint->effort(), -g, 1e-3);
    EXPECT_NEAR((rig.joint->force_W_N() - Vector3d(0, 0, 2 * g)).norm(), 0, 1e-3);
    EXPECT_NEAR((rig.joint->torque_W_Nm() - Vector3d(0, -g, 0)).norm(), 0, 1e-3);
  }
}

TEST(JointLoad, OfASliderThatLeavesItsStopIsTheForceAlongIt) {
  for (const bool to_world : {true, false}) {
    JointConfig config = joint("lift", JointType::slider, {0, 0, 0});
    config.axis1.low_stop = 0;
    Arm rig(config, to_world);
    run(*rig.world, 100);
    rig.joint->set_motor(1, 30);
    run(*rig.world, 1);
    EXPECT_NEAR(rig.joint->velocity(), (30.0 / 2 - g) * 0.01, 1e-6);
    EXPECT_NEAR(rig.joint->effort(), 30, 1e-4);
    EXPECT_NEAR((rig.joint->force_W_N() - Vector3d(0, 0, 30)).norm(), 0, 1e-4);
    EXPECT_NEAR((rig.joint->torque_W_Nm() - Vector3d(0, -15, 0)).norm(), 0, 1e-4);
  }
}

TEST(JointLoad, HasTheAddedEffortOfThatStep) {
  for (const bool to_world : {true, false}) {
    Arm rig(joint("elbow", JointType::hinge, {0, 0, 0}, Vector3d::UnitY()), to_world, false, 0);
    rig.joint->add_effort(0.5);
    rig.joint->add_effort(0.25);
    rig.world->step(0);
    EXPECT_NEAR(rig.joint->effort(), 0.75, 1e-9);
    EXPECT_GT(rig.arm->w_WB_W().y(), 0);
    rig.world->step(1);
    EXPECT_NEAR(rig.joint->effort(), 0, 1e-9);
  }
}

TEST(JointLoad, OfASliderIsTheForceAlongIt) {
  for (const bool to_world : {true, false}) {
    Arm rig(joint("lift", JointType::slider, {0, 0, 0}), to_world);
    rig.joint->set_motor(0, 100);
    run(*rig.world, 100);
    EXPECT_NEAR(rig.joint->effort(), 2 * g, 1e-4);
    EXPECT_NEAR((rig.joint->torque_W_Nm() - Vector3d(0, -g, 0)).norm(), 0, 1e-4);
    rig.joint->set_motor(0, 0);
    for (int i = 0; i < 100; ++i) {
      rig.joint->add_effort(2 * g);
      rig.world->step(i);
    }
    EXPECT_NEAR(rig.joint->effort(), 2 * g, 1e-9);
    EXPECT_NEAR((rig.joint->torque_W_Nm() - Vector3d(0, -g, 0)).norm(), 0, 1e-4);
  }
}

TEST(JointLoad, OfAUniversalJointIsReportedForEachAxis) {
  for (const bool to_world : {true, false}) {
    JointConfig config = joint("wrist", JointType::universal, {0, 0, 0}, Vector3d::UnitY());
    config.axis2.axis = Vector3d::UnitZ();
    Arm rig(config, to_world);
    for (const int axis : {0, 1}) rig.joint->set_motor(0, 100, axis);
    for (int i = 0; i < 100; ++i) {
      rig.arm->add_torque_W({0, 0, 2});
      rig.world->step(i);
    }
    EXPECT_NEAR(rig.joint->effort(0), -2 * g * 0.5, 1e-4);
    EXPECT_NEAR(rig.joint->effort(1), -2, 1e-4);
  }
}

TEST(JointStops, CanBeSetAndTakenAway) {
  for (const bool to_world : {true, false}) {
    Arm rig(joint("elbow", JointType::hinge, {0, 0, 0}, Vector3d::UnitY()), to_world, false, 0);
    rig.joint->set_stops(-0.3, 0.5);
    rig.joint->set_motor(1, 1);
    run(*rig.world, 300);
    EXPECT_NEAR(rig.joint->position(), 0.5, 0.01);
    rig.joint->set_motor(-1, 1);
    run(*rig.world, 300);
    EXPECT_NEAR(rig.joint->position(), -0.3, 0.01);
    rig.joint->set_stops(std::nullopt, std::nullopt);
    run(*rig.world, 300);
    EXPECT_LT(rig.joint->position(), -2);
  }
}

}  // namespace
