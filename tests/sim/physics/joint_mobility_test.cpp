// SPDX-License-Identifier: BSD-3-Clause
// The mobility of a joint is the change of its rate by an impulse in one step.

#include <gtest/gtest.h>

#include "sim/physics/joint.hpp"
#include "tests/sim/physics/small_worlds.hpp"

namespace {

using namespace small_worlds;

constexpr double softness = 5e-5;  // of the constraints, by the cfm of the world

PhysicsConfig free_of_gravity() {
  PhysicsConfig config;
  config.step_s = 0.001;
  config.gravity_mps2 = 0;
  return config;
}

/// Two cubes of different mass 0.7 m apart, or the second one alone at a joint to the world.
struct TwoCubes {
  explicit TwoCubes(const JointConfig& config, Motion motion_of_first = Motion::free)
      : world(make_world(free_of_gravity())) {
    const int group = world->add_group("rig");
    sim::Body& first =
        world->add_body(group, body("base", {box({0.2, 0.3, 0.2}, 12)}), Pose::Identity(), motion_of_first);
    sim::Body& second = world->add_body(group, body("arm", {box({0.2, 0.2, 0.3}, 8.4)}, {0.7, 0, 0}), Pose::Identity());
    joint = &world->add_joint(group, config, first, &second, Pose::Identity());
    world->close_group(group);
  }
  /// Rate after one step with an effort of 1, over the step.
  double measured(int axis) {
    joint->add_effort(1, axis);
    world->step(0);
    return joint->velocity(axis) / 0.001;
  }
  std::unique_ptr<PhysicsWorld> world;
  sim::Joint* joint;
};

TEST(JointMobility, OfAHingeIsTheResponseToATorque) {
  // Axis and anchor in a plane of symmetry: the other two rows of the hinge have no effect.
  const JointConfig config = joint("j", JointType::hinge, {0.2, 0, 0}, Vector3d::UnitY());
  TwoCubes both(config);
  EXPECT_NEAR(both.joint->mobility() / both.measured(0), 1, softness);
  TwoCubes one(config, Motion::fixed);
  // Of a cuboid of 8.4 kg about its end: m (0.5^2 + (0.2^2 + 0.3^2) / 12).
  EXPECT_NEAR(one.joint->mobility(), 1 / (8.4 * (0.25 + 0.13 / 12)), 1e-9);
  EXPECT_NEAR(one.joint->mobility() / one.measured(0), 1, softness);
}

TEST(JointMobility, OfASliderIsTheResponseToAForce) {
  TwoCubes both(joint("j", JointType::slider, {0.2, 0, 0}, Vector3d::UnitX()));
  EXPECT_NEAR(both.joint->mobility(), 1 / 12.0 + 1 / 8.4, 1e-9);
  EXPECT_NEAR(both.joint->mobility() / both.measured(0), 1, softness);
}

TEST(JointMobility, IsNeverBelowTheResponse) {
  for (const Vector3d& axis : {Vector3d(0, 1, 0.4), Vector3d(0.3, 1, 0.4), Vector3d(1, 1, 1)}) {
    TwoCubes rig(joint("j", JointType::hinge, {0.2, 0.1, -0.05}, axis.normalized()));
    const double mobility = rig.joint->mobility();
    EXPECT_GE(mobility, rig.measured(0) * (1 - softness));
  }
  for (const int axis : {0, 1}) {
    JointConfig config = joint("j", JointType::universal, {0.2, 0, 0}, Vector3d::UnitY());
    config.axis2.axis = Vector3d::UnitZ();
    TwoCubes rig(config);
    const double mobility = rig.joint->mobility(axis);
    EXPECT_GE(mobility, rig.measured(axis) * (1 - softness));
  }
}

}  // namespace
