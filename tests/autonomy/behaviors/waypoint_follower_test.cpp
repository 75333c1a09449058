// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/waypoint_follower.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "autonomy/behaviors/obstacle_avoidance.hpp"
#include "tests/autonomy/behaviors/flat_room.hpp"

namespace {

using autonomy::Pose2;
using autonomy::Vector2d;
using autonomy::WaypointFollower;

TEST(WaypointFollower, SeesTheGoalFromTheRover) {
  WaypointFollower follower({{0, 10}});
  const Vector2d goal_B = follower.goal_B({{0, 0}, 0}, 0);  // looking east, the north is to the left
  EXPECT_NEAR(goal_B.x(), 0, 1e-12);
  EXPECT_NEAR(goal_B.y(), 10, 1e-12);
}

TEST(WaypointFollower, GoesRoundAndRound) {
  WaypointFollower follower({{5, 0}, {0, 5}});
  for (int round = 0; round < 3; ++round) {
    EXPECT_EQ(follower.current(), 0u);
    follower.goal_B({{4.5, 0}, 0}, round);
    EXPECT_EQ(follower.current(), 1u);
    follower.goal_B({{0, 4.5}, 0}, round + 0.5);
  }
  EXPECT_EQ(follower.reached(), 6);
}

TEST(WaypointFollower, GivesUpAWaypointThatComesNoNearer) {
  WaypointFollower follower({{5, 0}, {0, 5}});
  const double timeout_s = WaypointFollower::Params().give_up_s;
  follower.goal_B({{0, 0}, 0}, 0);
  follower.goal_B({{0.1, 0}, 0}, timeout_s - 0.1);  // a few centimeters are not progress
  EXPECT_EQ(follower.current(), 0u);
  follower.goal_B({{0.1, 0}, 0}, timeout_s + 0.1);
  EXPECT_EQ(follower.current(), 1u);
  EXPECT_EQ(follower.given_up(), 1);
}

TEST(WaypointFollower, KeepsAWaypointThatComesNearerSlowly) {
  WaypointFollower follower({{100, 0}, {0, 5}});
  for (int i = 0; i < 90; ++i) follower.goal_B({{i * 0.5, 0}, 0}, i * 20.0);
  EXPECT_EQ(follower.given_up(), 0);
}

TEST(WaypointFollower, ReachesAllWaypointsInAFreeField) {
  const std::vector<Vector2d> waypoints = {{10, 0}, {10, 10}, {-10, 10}, {0, 0}};
  WaypointFollower follower(waypoints);
  autonomy::ObstacleAvoidance avoidance;
  Pose2 pose{{0, 0}, 3};  // looking away from the first
  const double length_m = 10 + 10 + 20 + std::hypot(10, 10);
  const double dt_s = 0.1;
  double t_s = 0;
  for (; t_s < 1000 && follower.reached() < 4; t_s += dt_s)
    pose = flat_room::driven(pose, avoidance.steer(follower.goal_B(pose, t_s), flat_room::scan({}, pose)), dt_s);
  EXPECT_EQ(follower.reached(), 4);
  // Half a turn at 1 rad/s at each of five corners at the most, on top of the way.
  EXPECT_LT(t_s, length_m / 0.8 + 5 * 3.2);
}

TEST(WaypointFollower, NeedsAWaypoint) {
  EXPECT_THROW(WaypointFollower({}), std::invalid_argument);
}

}  // namespace
