// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/obstacle_avoidance.hpp"

#include <gtest/gtest.h>

#include "tests/autonomy/behaviors/flat_room.hpp"

namespace {

using autonomy::ObstacleAvoidance;
using autonomy::Pose2;
using autonomy::Twist;
using autonomy::Vector2d;
using flat_room::Wall;

/// Middle of the rover to its farthest corner: half of 0.5 m along, wheels 0.3 m beside.
constexpr double rover_radius_m = 0.39;

TEST(ObstacleAvoidance, DrivesStraightToAGoalAhead) {
  ObstacleAvoidance avoidance;
  const Twist twist = avoidance.steer({10, 0}, flat_room::scan({}, {}));
  EXPECT_DOUBLE_EQ(twist.forward_mps, ObstacleAvoidance::Params().speed_mps);
  EXPECT_DOUBLE_EQ(twist.turn_radps, 0);
}

TEST(ObstacleAvoidance, TurnsToAGoalOnTheLeft) {
  ObstacleAvoidance avoidance;
  EXPECT_GT(avoidance.steer({0, 10}, flat_room::scan({}, {})).turn_radps, 0.5);
}

TEST(ObstacleAvoidance, MeasuresTheLane) {
  const ObstacleAvoidance avoidance;
  const auto scan = flat_room::scan({{{3, -1}, {3, 0.2}}}, {});  // stands 3 m ahead, mostly to the right
  EXPECT_NEAR(avoidance.free_distance_m(scan, 0), 3, 1e-6);
  // Beside the lane; what nothing was hit by reports the maximum range of 20 m.
  EXPECT_GT(avoidance.free_distance_m(flat_room::scan({{{3, 1}, {3, 2}}}, {}), 0), 19);
}

TEST(ObstacleAvoidance, TurnsAwayFromWhatStandsInTheWay) {
  const auto turn = [](const Wall& wall) {
    return ObstacleAvoidance().steer({10, 0}, flat_room::scan({wall}, {})).turn_radps;
  };
  EXPECT_LT(turn({{2, -0.2}, {2, 2}}), 0);  // it reaches far to the left: pass on the right
  EXPECT_GT(turn({{2, -2}, {2, 0.2}}), 0);
}

TEST(ObstacleAvoidance, SlowsBeforeAnObstacleAndStopsAtIt) {
  const ObstacleAvoidance::Params params;
  const std::vector<Wall> ahead = {{{0.9, -5}, {0.9, 5}}};
  // All directions are blocked within the look-ahead: it turns on the spot.
  EXPECT_EQ(ObstacleAvoidance().steer({10, 0}, flat_room::scan(ahead, {})).forward_mps, 0);
  const std::vector<Wall> post = {{{1.275, -0.1}, {1.275, 0.1}}};  // half of the way from stop to slow
  const Twist twist = ObstacleAvoidance().steer({10, 0}, flat_room::scan(post, {}));
  EXPECT_LE(twist.forward_mps, 0.5 * params.speed_mps + 1e-6);
  EXPECT_NE(twist.turn_radps, 0);
}

/// Drives in a room towards a goal.  Returns the smallest distance from a wall on the way.
double drive(const std::vector<Wall>& walls, Pose2& pose, const Vector2d& goal_W, double duration_s) {
  ObstacleAvoidance avoidance;
  double nearest = 1e9;
  for (double t_s = 0; t_s < duration_s && (goal_W - pose.p_W).norm() > 1; t_s += 0.1) {
    const Vector2d goal_B = autonomy::turned(goal_W - pose.p_W, -pose.yaw_rad);
    pose = flat_room::driven(pose, avoidance.steer(goal_B, flat_room::scan(walls, pose)), 0.1);
    nearest = std::min(nearest, flat_room::distance_m(walls, pose.p_W));
  }
  return nearest;
}

TEST(ObstacleAvoidance, GetsOutOfEveryCorner) {
  const std::vector<Wall> room = flat_room::box(10, 10);
  for (int i = 0; i < 16; ++i) {
    const double yaw = i * std::numbers::pi / 8;
    Pose2 pose{{9.2, 9.2}, yaw};
    const double nearest = drive(room, pose, {0, 0}, 60);
    EXPECT_LT(pose.p_W.norm(), 1.0 + 1e-9) << "from yaw " << yaw;
    EXPECT_GT(nearest, rover_radius_m) << "from yaw " << yaw;
  }
}

TEST(ObstacleAvoidance, PassesABlockOnItsWay) {
  std::vector<Wall> walls = flat_room::box(20, 20);
  for (Wall wall : flat_room::box(1, 1)) walls.push_back(wall);
  for (const double y_m : {-0.9, -0.3, 0.0, 0.4, 0.8}) {
    Pose2 pose{{-10, y_m}, 0};
    const double nearest = drive(walls, pose, {10, 0}, 60);
    EXPECT_LT((pose.p_W - Vector2d(10, 0)).norm(), 1.0 + 1e-9) << "from y " << y_m;
    EXPECT_GT(nearest, rover_radius_m) << "from y " << y_m;
  }
}

TEST(ObstacleAvoidance, DoesNotRunIntoTheWallBeforeAGoalBehindIt) {
  const std::vector<Wall> room = flat_room::box(10, 10);
  Pose2 pose{{0, 0}, 0.3};
  EXPECT_GT(drive(room, pose, {15, 0}, 120), rover_radius_m);
}

TEST(ObstacleAvoidance, TwoRoversThatMeetPassEachOther) {
  ObstacleAvoidance avoidance[2];
  Pose2 pose[2] = {{{-8, 0}, 0}, {{8, 0}, std::numbers::pi}};
  const Vector2d goal_W[2] = {{8, 0}, {-8, 0}};
  double nearest = 1e9;
  for (int step = 0; step < 600; ++step) {
    Twist twist[2];
    for (int i = 0; i < 2; ++i) {
      const std::vector<Wall> other = [&] {
        std::vector<Wall> walls = flat_room::box(0.3, 0.3);
        for (Wall& wall : walls) wall = {wall.a + pose[1 - i].p_W, wall.b + pose[1 - i].p_W};
        return walls;
      }();
      const Vector2d goal_B = autonomy::turned(goal_W[i] - pose[i].p_W, -pose[i].yaw_rad);
      if (goal_B.norm() > 1) twist[i] = avoidance[i].steer(goal_B, flat_room::scan(other, pose[i]));
    }
    for (int i = 0; i < 2; ++i) pose[i] = flat_room::driven(pose[i], twist[i], 0.1);
    nearest = std::min(nearest, (pose[0].p_W - pose[1].p_W).norm());
  }
  for (int i = 0; i < 2; ++i) EXPECT_LT((goal_W[i] - pose[i].p_W).norm(), 1.01);
  EXPECT_GT(nearest, 2 * rover_radius_m);
}

}  // namespace
