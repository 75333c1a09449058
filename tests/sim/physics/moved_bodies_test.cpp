// SPDX-License-Identifier: BSD-3-Clause
#include "sim/physics/moved_bodies.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/sim/physics/step_objects.hpp"

namespace {

using namespace small_worlds;

PhysicsConfig with_limits(double max_speed_mps, double max_distance_m) {
  PhysicsConfig config = weightless();
  config.max_speed_mps = max_speed_mps;
  config.max_distance_m = max_distance_m;
  return config;
}

std::string fault_of(const StepObjects& objects) {
  try {
    objects.moved.throw_first_fault(objects.groups, 7);
  } catch (const sim::PhysicsFault& fault) {
    return fault.what();
  }
  return "";
}

TEST(MovedBodies, AreWithinTheLimitsUpToTheLimitsThemselves) {
  StepObjects objects(with_limits(10, 100));
  sim::SteppedBody& ball = objects.add_ball("ball", 100, 10);
  EXPECT_FALSE(objects.moved.is_out_of_bounds(ball));
  EXPECT_EQ(fault_of(objects), "");
  ball.set_velocity_W({10.1, 0, 0}, Vector3d::Zero());
  EXPECT_TRUE(objects.moved.is_out_of_bounds(ball));
  EXPECT_EQ(fault_of(objects), "body 'ball': speed 10 m/s is over 10 m/s at step 7");
  ball.set_velocity_W({0, 0, 0}, Vector3d::Zero());
  ball.set_pose(translation(0, 0, -101));
  EXPECT_EQ(fault_of(objects), "body 'ball': distance 101 m from the origin is over 100 m at step 7");
}

TEST(MovedBodies, AreOutOfBoundsWhenANumberIsNotFinite) {
  StepObjects objects;
  sim::SteppedBody& ball = objects.add_ball("ball", 0);
  const double none = std::numeric_limits<double>::quiet_NaN();
  const_cast<double*>(ball.v_WC_W())[1] = none;  // as a step of ODE may leave it
  EXPECT_EQ(fault_of(objects), "body 'ball': velocity is not finite at step 7");
  const_cast<double*>(ball.p_WC())[0] = none;
  EXPECT_EQ(fault_of(objects), "body 'ball': position is not finite at step 7");
}

TEST(MovedBodies, AreReportedInTheOrderOfTheirGroups) {
  StepObjects objects(with_limits(10, 100));
  objects.add_ball("inside", 0);
  objects.add_ball("first", 200);
  objects.add_ball("second", 300);
  EXPECT_THAT(fault_of(objects), testing::StartsWith("body 'first'"));
}

TEST(MovedBodies, AreCollectedByWhatIsToBeLookedAt) {
  StepObjects objects;
  objects.add_ball("resting", 0);
  sim::SteppedBody& fast = objects.add_ball("fast", 10);
  sim::SteppedBody& leaving = objects.add_ball("leaving", 20);
  for (const sim::Group& group : objects.groups.all()) objects.leaps.plan(group);
  // A ball of 1 m moves by its size in a step of 10 ms at 100 m/s.
  fast.set_velocity_W({101, 0, 0}, Vector3d::Zero());
  leaving.start_box(0.1);
  leaving.set_pose(translation(20.2, 0, 0));
  sim::MovedBodies::Batch batch;
  objects.groups.for_each_moving([&](const sim::SteppedBody& body) { objects.moved.look_at(body, batch); });
  EXPECT_THAT(batch.fast, testing::ElementsAre(fast.number()));
  EXPECT_THAT(batch.left, testing::ElementsAre(leaving.group()));
  EXPECT_FALSE(batch.out_of_bounds);
}

}  // namespace
