// SPDX-License-Identifier: BSD-3-Clause
#include "devices/autopilot/thrust_allocation.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace {

using devices::ThrustAllocation;
using devices::ThrusterPlace;
using devices::Wrench;

ThrusterPlace thruster(const sim::Vector3d& position_m, const sim::Vector3d& rpy_deg, double limit_N = 40) {
  ThrusterPlace place;
  place.X_ST = sim::make_pose(position_m, rpy_deg * sim::degrees_to_radians(1));
  place.max_N = limit_N;
  place.min_N = -limit_N;
  return place;
}

/// Eight thrusters as of a BlueROV2 Heavy: four in the plane at 45 degrees, four upwards.
std::vector<ThrusterPlace> heavy() {
  std::vector<ThrusterPlace> all;
  for (const double x : {1.0, -1.0})
    for (const double y : {1.0, -1.0}) {
      all.push_back(thruster({0.156 * x, 0.111 * y, 0.01}, {0, 0, -45 * x * y}));
      all.push_back(thruster({0.12 * x, 0.218 * y, 0}, {0, -90, 0}));
    }
  return all;
}

Wrench some_wrench() {
  Wrench wrench;
  wrench << 10, -7, 5, 0.5, -0.8, 1.2;
  return wrench;
}

TEST(ThrustAllocation, GivesTheWrenchOfEightThrustersExactly) {
  const ThrustAllocation allocation(heavy(), {});
  EXPECT_EQ(allocation.axes().size(), 6u);
  Eigen::VectorXd forces;
  EXPECT_EQ(allocation.allocate(some_wrench(), forces), 1);
  EXPECT_NEAR((allocation.wrench_of(forces) - some_wrench()).norm(), 0, 1e-12);
}

TEST(ThrustAllocation, ScalesAllForcesByOneNumberWhereOneIsOverItsLimit) {
  const ThrustAllocation allocation(heavy(), {});
  Eigen::VectorXd forces;
  Wrench desired = 100 * some_wrench();
  desired.segment<2>(3).setZero();
  const double scale = allocation.allocate(desired, forces);
  EXPECT_LT(scale, 1);
  EXPECT_NEAR(forces.cwiseAbs().maxCoeff(), 40, 1e-12);
  EXPECT_NEAR((allocation.wrench_of(forces) - scale * desired).norm(), 0, 1e-10);
}

TEST(ThrustAllocation, RollAndPitchComeFirst) {
  const ThrustAllocation allocation(heavy(), {});
  Eigen::VectorXd forces;
  Wrench level = Wrench::Zero(), rest = 100 * some_wrench();
  level.segment<2>(3) << 3, -2;
  rest.segment<2>(3).setZero();
  const double scale = allocation.allocate(level + rest, forces);
  EXPECT_GT(scale, 0);
  EXPECT_LT(scale, 1);
  EXPECT_NEAR(forces.cwiseAbs().maxCoeff(), 40, 1e-12);
  EXPECT_NEAR((allocation.wrench_of(forces) - level - scale * rest).norm(), 0, 1e-10);
  // Too much of them leaves nothing to the others: 4 x 40 N x 0.218 m about x.
  level.segment<2>(3) << 1000, 0;
  EXPECT_NEAR(allocation.allocate(level + rest, forces), 0, 1e-12);
  EXPECT_NEAR(allocation.wrench_of(forces)[3], 4 * 40 * 0.218, 1e-9);
}

TEST(ThrustAllocation, AThrusterOfTwiceTheWeightDoesHalfAsMuch) {
  std::vector<ThrusterPlace> two{thruster({-0.5, 0.1, 0}, {0, 0, 0}), thruster({-0.5, -0.1, 0}, {0, 0, 0})};
  two[0].weight = 2;
  const ThrustAllocation allocation(two, {0});
  Wrench ahead = Wrench::Zero();
  ahead[0] = 30;
  Eigen::VectorXd forces;
  allocation.allocate(ahead, forces);
  EXPECT_NEAR(forces[0], 10, 1e-12);
  EXPECT_NEAR(forces[1], 20, 1e-12);
}

TEST(ThrustAllocation, TwoPropellersSideBySidePushAndTurn) {
  const std::vector<ThrusterPlace> two{thruster({-1, 0.395, -0.1}, {0, 0, 0}), thruster({-1, -0.395, -0.1}, {0, 0, 0})};
  const ThrustAllocation allocation(two, {});
  EXPECT_EQ(allocation.axes(), (std::vector<int>{0, 5}));
  Wrench desired = Wrench::Zero();
  desired[0] = 20;
  desired[5] = 3.95;
  Eigen::VectorXd forces;
  allocation.allocate(desired, forces);
  EXPECT_NEAR(forces[0], 5, 1e-12);  // port
  EXPECT_NEAR(forces[1], 15, 1e-12);
}

TEST(ThrustAllocation, AsternHasALimitOfItsOwn) {
  std::vector<ThrusterPlace> one{thruster({0, 0, 0}, {0, 0, 0})};
  one[0].min_N = -10;
  const ThrustAllocation allocation(one, {0});
  Wrench desired = Wrench::Zero();
  desired[0] = -20;
  Eigen::VectorXd forces;
  EXPECT_DOUBLE_EQ(allocation.allocate(desired, forces), 0.5);
  EXPECT_DOUBLE_EQ(forces[0], -10);
}

std::vector<ThrusterPlace> two_that_push_ahead_only() {
  std::vector<ThrusterPlace> two{thruster({-1, 0.4, 0}, {0, 0, 0}), thruster({-1, -0.4, 0}, {0, 0, 0})};
  for (ThrusterPlace& one : two) one.min_N = 0;
  return two;
}

TEST(ThrustAllocation, WhatAOneWayThrusterCannotGiveDoesNotStopTheOthers) {
  const ThrustAllocation allocation(two_that_push_ahead_only(), {});
  Wrench desired = Wrench::Zero();
  desired[0] = 10;
  desired[5] = 8;
  Eigen::VectorXd forces;
  // With both ways port would give -5 N and starboard 15 N.  Starboard alone gives f ahead and 0.4 m f about z; the
  // errors, the torque over its arm, are least at f = (10 + 8 / 0.4) / 2, and the share given is 2 f^2 / (10^2 + 20^2).
  EXPECT_NEAR(allocation.allocate(desired, forces), 0.9, 1e-12);
  EXPECT_EQ(forces[0], 0);
  EXPECT_NEAR(forces[1], 15, 1e-12);
}

TEST(ThrustAllocation, ADemandBelowZeroByRoundingTakesNothingAway) {
  const ThrustAllocation allocation(two_that_push_ahead_only(), {});
  Wrench desired = Wrench::Zero();
  desired[0] = 10;
  desired[5] = 4 * (1 + 1e-15);  // port: 5 - 5 (1 + 1e-15)
  Eigen::VectorXd forces;
  EXPECT_NEAR(allocation.allocate(desired, forces), 1, 1e-12);
  EXPECT_NEAR(forces[1], 10, 1e-12);
  desired[0] = -10;
  EXPECT_NEAR(allocation.allocate(desired, forces), 0, 1e-12) << "nobody pushes astern";
  EXPECT_NEAR(forces.norm(), 0, 1e-12);
}

TEST(ThrustAllocation, OthersTakeOverWhatAOneWayThrusterCannotGive) {
  std::vector<ThrusterPlace> three{thruster({0, 0, 0}, {0, 0, 0}), thruster({0, 0, 0}, {0, 0, 0}),
                                   thruster({0, 0, 0}, {0, 0, 0})};
  three[0].min_N = 0;
  const ThrustAllocation allocation(three, {0});
  Wrench desired = Wrench::Zero();
  desired[0] = -30;
  Eigen::VectorXd forces;
  EXPECT_NEAR(allocation.allocate(desired, forces), 1, 1e-12);
  EXPECT_NEAR((forces - Eigen::Vector3d(0, -15, -15)).norm(), 0, 1e-12);
}

TEST(ThrustAllocation, NoForceForAWrenchThatIsNoNumber) {
  const ThrustAllocation allocation(heavy(), {});
  Wrench desired = some_wrench();
  desired[2] = std::numeric_limits<double>::quiet_NaN();
  Eigen::VectorXd forces;
  EXPECT_EQ(allocation.allocate(desired, forces), 0);
  EXPECT_TRUE(forces.isZero());
}

TEST(ThrustAllocation, AThrusterThatPushesNowhereIsLeftOut) {
  std::vector<ThrusterPlace> two{thruster({0, 0, 0}, {0, 0, 0}), thruster({0, 0, 0}, {0, 0, 0}, 0)};
  const ThrustAllocation allocation(two, {0});
  Wrench desired = Wrench::Zero();
  desired[0] = 10;
  Eigen::VectorXd forces;
  EXPECT_NEAR(allocation.allocate(desired, forces), 1, 1e-12);
  EXPECT_NEAR(forces[0], 10, 1e-12);
  EXPECT_EQ(forces[1], 0);
}

TEST(ThrustAllocation, SaysWhichAxisTheThrustersCannotGive) {
  try {
    ThrustAllocation allocation({thruster({-1, 0.4, 0}, {0, 0, 0}), thruster({-1, -0.4, 0}, {0, 0, 0})}, {0, 1});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "the thrusters cannot give sway in addition to the axes before it");
  }
}

}  // namespace
