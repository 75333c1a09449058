// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/stepped_joint.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/physics/step_objects.hpp"

namespace {

using namespace small_worlds;

/// Two cubes with a hinge about z between them, 1 m apart.
struct HingedCubes {
  HingedCubes() : group(objects.add_group("rig")) {
    first = &objects.add_body(group, body("first", {box({0.2, 0.2, 0.2}, 1)}), Pose::Identity());
    second = &objects.add_body(group, body("second", {box({0.2, 0.2, 0.2}, 1)}), translation(1, 0, 0));
    hinge = &objects.add_joint(group, joint("hinge", JointType::hinge, {0.5, 0, 0}), *first, second);
    objects.close(group);
  }
  StepObjects objects;
  int group;
  sim::SteppedBody* first;
  sim::SteppedBody* second;
  sim::SteppedJoint* hinge;
};

TEST(SteppedJoint, KnowsWhetherItIsToTheWorld) {
  HingedCubes cubes;
  EXPECT_FALSE(cubes.hinge->origin().to_world);
  const sim::SteppedJoint& post =
      cubes.objects.add_joint(cubes.group, joint("post", JointType::fixed, {0, 0, 0}), *cubes.first, nullptr);
  EXPECT_TRUE(post.origin().to_world);
  EXPECT_TRUE(cubes.objects.groups[cubes.group].anchored);
}

TEST(SteppedJoint, HasTheRowsOfItsMotor) {
  HingedCubes cubes;
  const int rows = cubes.hinge->max_rows();
  EXPECT_GE(rows, 5) << "a hinge leaves one of six directions free";
  EXPECT_LE(rows, 6) << "which its motor holds";
}

TEST(SteppedJoint, KeepsItsPositionInAnotherOdeWorld) {
  HingedCubes cubes;
  // Turn the second body about the hinge by 0.3 rad.
  cubes.second->set_pose(sim::make_pose({0.5 + 0.5 * std::cos(0.3), 0.5 * std::sin(0.3), 0}, {0, 0, 0.3}));
  cubes.hinge->update_position(0.01);
  ASSERT_NEAR(cubes.hinge->position(), 0.3, 1e-12);
  const double before = cubes.hinge->position();
  cubes.hinge->create_again(dBodyGetWorld(cubes.first->ode()), cubes.second->ode(), cubes.first->ode());
  cubes.hinge->create_again(dBodyGetWorld(cubes.first->ode()), cubes.first->ode(), cubes.second->ode());
  cubes.hinge->update_position(0.01);
  EXPECT_NEAR(cubes.hinge->position(), before, 1e-12) << "its zero is that of its first creation";
}

TEST(SteppedJoint, IsMeasuredOnlyWhenItIsAskedTo) {
  HingedCubes cubes;
  EXPECT_FALSE(cubes.hinge->is_measured());
  cubes.hinge->measure_load();
  EXPECT_TRUE(cubes.hinge->is_measured());
}

}  // namespace
