// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/stepped_body.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/sim/physics/step_objects.hpp"

namespace {

using namespace small_worlds;

std::vector<double> motion_of(const sim::SteppedBody& body) {
  std::vector<double> numbers(body.p_WC(), body.p_WC() + 3);
  numbers.insert(numbers.end(), body.v_WC_W(), body.v_WC_W() + 3);
  numbers.insert(numbers.end(), body.w_WB_W_of_ode(), body.w_WB_W_of_ode() + 3);
  const dReal* q = dBodyGetQuaternion(body.ode());
  numbers.insert(numbers.end(), q, q + 4);
  return numbers;
}

TEST(SteppedBody, IsTheSameInAnotherOdeWorldToTheLastBit) {
  StepObjects objects;
  sim::SteppedBody& box_body =
      objects.add(body("box", {box({1, 2, 3}, 7)}), sim::make_pose({0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}));
  box_body.set_velocity_W({1, 2, 3}, {0.1, 0.2, 0.3});
  for (int i = 0; i < 100; ++i) box_body.step_alone(0.01, 9.8);
  const std::vector<double> before = motion_of(box_body);
  const sim::WorldHandle other(dWorldCreate());
  const sim::BodyHandle old = box_body.create_again(other.get());
  EXPECT_EQ(dBodyGetWorld(box_body.ode()), other.get());
  EXPECT_EQ(motion_of(box_body), before);
  dMass mass;
  dBodyGetMass(box_body.ode(), &mass);
  EXPECT_EQ(mass.mass, 7);
  EXPECT_NE(dBodyGetFirstGeom(old.get()), nullptr) << "the old one keeps the parts until they are handed over";
  // Destroy the geoms before the bodies that they are on.
  objects.collider.remove_group(0, objects.groups[0].bodies, objects.groups[0].parts);
  box_body.create_again(objects.shards.world_of(0));
}

TEST(SteppedBody, TakesTheMassThatIsPublishedInAxesThatPointForwardRightDown) {
  StepObjects objects;
  BodyConfig config = body("hull", {sphere(1, 5)});
  config.hydrodynamics.emplace();
  config.hydrodynamics->mass_kg = 100;
  config.hydrodynamics->center_of_mass_m = {0.1, 0.2, 0.3};
  config.hydrodynamics->inertia_kgm2 = Vector3d(10, 20, 30).asDiagonal();
  const sim::SteppedBody& hull = objects.add(config, Pose::Identity());
  EXPECT_EQ(hull.mass_kg(), 100);
  EXPECT_TRUE(hull.p_BC().isApprox(Vector3d(0.1, -0.2, -0.3), 1e-12)) << "left and up are positive here";
  EXPECT_TRUE(hull.inertia_C_B().isApprox(sim::Matrix3d(Vector3d(10, 20, 30).asDiagonal()), 1e-9));
}

TEST(SteppedBody, OfEqualMomentsHasNoGyroscopicTorque) {
  StepObjects objects;
  EXPECT_FALSE(objects.add(body("cube", {box({1, 1, 1}, 1)}), Pose::Identity()).gyroscopic());
  EXPECT_TRUE(objects.add(body("bar", {box({3, 1, 1}, 1)}), translation(10, 0, 0)).gyroscopic());
  EXPECT_FALSE(objects.add(body("moved", {box({3, 1, 1}, 0)}), translation(20, 0, 0), Motion::kinematic).gyroscopic());
}

TEST(SteppedBody, LeavesItsBoxWhenACoordinateDoes) {
  StepObjects objects;
  sim::SteppedBody& ball = objects.add_ball("ball", 5);
  EXPECT_FALSE(ball.left_its_box()) << "it has none";
  EXPECT_EQ(ball.start_box(0.5), Vector3d(5, 0, 0));
  ball.set_pose(translation(5.4, 0.4, -0.4));
  EXPECT_FALSE(ball.left_its_box()) << "0.69 m away, but each coordinate within 0.5 m";
  ball.set_pose(translation(5, 0, 0.6));
  EXPECT_TRUE(ball.left_its_box());
  ball.forget_box();
  EXPECT_FALSE(ball.left_its_box());
}

TEST(SteppedBody, TakesOneStepOfFirstOrderOrAll) {
  StepObjects objects;
  sim::SteppedBody& ball = objects.add_ball("ball", 0);
  EXPECT_FALSE(ball.takes_first_order_step());
  ball.take_first_order_step(0.01);
  EXPECT_TRUE(ball.takes_first_order_step());
  ball.end_first_order_step();
  EXPECT_FALSE(ball.takes_first_order_step());
  ball.use_first_order();
  ball.end_first_order_step();
  EXPECT_TRUE(ball.takes_first_order_step());
}

}  // namespace
