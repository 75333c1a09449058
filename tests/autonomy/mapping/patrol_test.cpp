// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/patrol.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/base/math.hpp"
#include "tests/autonomy/mapping/drawn_room.hpp"

namespace {

using autonomy::Patrol;
using autonomy::Pose2;
using autonomy::Twist;
using autonomy::Vector2d;

constexpr std::int64_t patrol_second = 1'000'000;

/// A vehicle on a free ground that does what it is commanded.
struct PatrolRun {
  explicit PatrolRun(Patrol::Params params) : patrol(params) {}
  Twist tick() {
    utime += patrol_second;
    patrol.receive(test::odometry_at(pose, utime));
    patrol.receive(test::DrawnRoom{}.scan(pose, utime));
    shoal::estimate_t estimate{};
    estimate.utime = utime;
    estimate.position_m[0] = pose.p_W.x();
    estimate.position_m[1] = pose.p_W.y();
    estimate.yaw_rad = pose.yaw_rad;
    estimate.covariance_m2[0] = estimate.covariance_m2[4] = variance_m2;
    patrol.receive(estimate);
    const Twist twist = patrol.step(utime);
    // In small steps.
    for (int i = 0; i < 50; ++i) {
      pose.yaw_rad += twist.turn_radps / 50;
      pose.p_W += twist.forward_mps / 50 * Vector2d(std::cos(pose.yaw_rad), std::sin(pose.yaw_rad));
    }
    return twist;
  }
  Patrol patrol;
  Pose2 pose;
  std::int64_t utime = 0;
  double variance_m2 = 0.01;
};

Patrol::Params square() {
  Patrol::Params params;
  params.waypoints_W = {{0, 0}, {5, 0}, {5, 5}, {0, 5}};
  params.pause_s = 5;
  params.charge_s = 100;
  return params;
}

TEST(Patrol, DrivesRoundsAndRestsAtItsWaypoints) {
  PatrolRun run(square());
  int resting = 0;
  for (int i = 0; i < 1000; ++i) {
    const Twist twist = run.tick();
    resting += twist.forward_mps == 0 && twist.turn_radps == 0 ? 1 : 0;
  }
  // It starts at the first waypoint.  A round is 20 m at 0.6 m/s, 33 s, with turns, and rests of 100 s and three of 5
  // s.
  EXPECT_GE(run.patrol.rounds(), 5);
  EXPECT_LE(run.patrol.rounds(), 1000 / 148);
  EXPECT_EQ(run.patrol.follower()->given_up(), 0);
  EXPECT_GT(resting, 500);
}

TEST(Patrol, TurnsAndDrivesInTurnsWhileTheEstimateIsUncertain) {
  PatrolRun run(square());
  run.variance_m2 = 100;
  const Twist twist = run.tick();
  EXPECT_EQ(twist.forward_mps, 0);
  EXPECT_EQ(twist.turn_radps, 0.4);
  // 15 further seconds until a full turn, then 8 s at up to 0.6 m/s.
  for (int i = 0; i < 15; ++i) EXPECT_EQ(run.tick().forward_mps, 0);
  for (int i = 0; i < 8; ++i) run.tick();
  EXPECT_GT(run.pose.p_W.norm(), 3);
  EXPECT_EQ(run.tick().turn_radps, 0.4);
}

TEST(Patrol, MovesAnOldEstimateByItsOdometry) {
  PatrolRun run(square());
  // The estimate of 1 s says (10, 0), towards north; odometry has gone 2 m ahead since, so it is at (10, 2).
  run.patrol.receive(test::odometry_at({{3, 0}, 0}, patrol_second));
  run.patrol.receive(test::odometry_at({{5, 0}, 0}, 2 * patrol_second));
  shoal::estimate_t estimate{};
  estimate.utime = patrol_second;
  estimate.position_m[0] = 10;
  estimate.yaw_rad = std::numbers::pi / 2;
  run.patrol.receive(estimate);
  run.patrol.receive(test::DrawnRoom{}.scan({}, 2 * patrol_second));
  // The first waypoint, (0, 0), is to the left and behind: it turns left, most of the path.
  const Twist twist = run.patrol.step(2 * patrol_second);
  EXPECT_GT(twist.turn_radps, 0.1);
}

TEST(Patrol, StandsWhenAllItsReportsEnd) {
  PatrolRun run(square());
  for (int i = 0; i < 105; ++i) run.tick();
  ASSERT_GT(run.tick().forward_mps, 0);
  EXPECT_GT(run.patrol.step(run.utime + 2 * patrol_second).forward_mps, 0);
  EXPECT_EQ(run.patrol.step(run.utime + 3 * patrol_second).forward_mps, 0);
}

TEST(Patrol, DrivesAlongAPathAndStandsAtItsEnd) {
  Patrol::Params params;
  PatrolRun run(params);
  EXPECT_EQ(run.tick().forward_mps, 0);
  // Two legs with a corner, which it cuts by less than the 1 m that it looks ahead.
  run.patrol.receive(autonomy::path_message(0, {{0, 0}, {5, 0}, {5, 5}}));
  double farthest_m = 0;
  for (int i = 0; i < 40; ++i) {
    run.tick();
    farthest_m = std::max(farthest_m, std::min(std::abs(run.pose.p_W.y()), std::abs(run.pose.p_W.x() - 5)));
  }
  EXPECT_LT(farthest_m, 0.5);
  EXPECT_LT((run.pose.p_W - Vector2d(5, 5)).norm(), 0.3);
  EXPECT_EQ(run.tick().forward_mps, 0);
  // At that of one point it looks around; an empty one stops it.
  run.patrol.receive(autonomy::path_message(0, {run.pose.p_W}));
  EXPECT_EQ(run.tick().turn_radps, 0.4);
  run.patrol.receive(autonomy::path_message(0, {{0, 0}}));
  for (int i = 0; i < 5; ++i) run.tick();
  EXPECT_GT(run.tick().forward_mps, 0.1);
  run.patrol.receive(autonomy::path_message(0, {}));
  EXPECT_EQ(run.tick().forward_mps, 0);
}

TEST(Patrol, StandsWithoutAnEstimateOrAScan) {
  Patrol patrol(square());
  patrol.receive(test::odometry_at({}, patrol_second));
  EXPECT_EQ(patrol.step(patrol_second).forward_mps, 0);
}

}  // namespace
