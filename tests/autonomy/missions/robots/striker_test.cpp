// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/robots/striker.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace {

using autonomy::BallChase;
using autonomy::BallSighting;
using autonomy::ChaseCommand;
using autonomy::Striker;

/// A vehicle that moves as it is commanded, with a camera that sees 0.6 rad to both sides, and a ball at rest.
struct Played {
  ChaseCommand tick() {
    const double dx = ball_x_m - x_m, dy = ball_y_m - y_m;
    BallSighting ball;
    ball.utime = utime;
    ball.range_m = std::hypot(dx, dy);
    ball.bearing_rad = std::remainder(std::atan2(dy, dx) - yaw_rad, 2 * std::numbers::pi);
    range_m = ball.range_m;
    striker.head(yaw_rad);
    striker.see(std::abs(ball.bearing_rad) < 0.6 ? std::optional(ball) : std::nullopt);
    const ChaseCommand command = striker.step(utime);
    utime += 50'000;
    x_m += 0.05 * command.forward_mps * std::cos(yaw_rad);
    y_m += 0.05 * command.forward_mps * std::sin(yaw_rad);
    yaw_rad += 0.05 * command.turn_radps;
    return command;
  }
  /// Ticks until it kicks, or for 30 s.  Returns whether it kicks.
  bool play() {
    for (int i = 0; i < 600 && striker.chase().phase() != BallChase::Phase::kick; ++i) {
      tick();
      nearest_m = std::min(nearest_m, range_m);
    }
    return striker.chase().phase() == BallChase::Phase::kick;
  }
  /// Direction of a kick from here: towards the ball.
  double kick_rad() const { return std::atan2(ball_y_m - y_m, ball_x_m - x_m); }

  Striker striker{{.goal_yaw_rad = 0}};
  double x_m = 0, y_m = 0, yaw_rad = 0, ball_x_m = 2, ball_y_m = 0;
  double range_m = 0, nearest_m = 100;
  std::int64_t utime = 0;
};

TEST(Striker, KicksABallThatIsBetweenItAndTheGoalAtOnce) {
  Played test;
  EXPECT_TRUE(test.play());
  EXPECT_NEAR(test.y_m, 0, 0.01);
  EXPECT_LT(test.utime, 2'000'000);  // 0.8 m at 1.2 m/s
}

TEST(Striker, DrivesAroundABallToKickItTowardsTheGoal) {
  for (const double from_rad : {0.0, 0.7, 1.6, 2.5, -0.7, -1.6, -2.5}) {
    // On the side of the goal, and beside the ball, 2 m from it; it looks at the ball.
    Played test;
    test.ball_x_m = 0;
    test.x_m = 2 * std::cos(from_rad);
    test.y_m = 2 * std::sin(from_rad);
    test.yaw_rad = from_rad + std::numbers::pi;
    EXPECT_TRUE(test.play()) << from_rad;
    EXPECT_LT(std::abs(test.kick_rad()), 0.45) << from_rad;  // aligned_rad, and a tick
    EXPECT_GT(test.nearest_m, 0.45) << from_rad;             // it does not touch it on its way
  }
}

TEST(Striker, KicksInAnyDirectionWithoutAGoal) {
  Played test;
  test.striker = Striker(Striker::Params{});
  test.yaw_rad = std::numbers::pi;
  test.ball_x_m = -2;
  EXPECT_TRUE(test.play());
  EXPECT_NEAR(std::abs(test.kick_rad()), std::numbers::pi, 0.2);
}

TEST(Striker, SearchesABallThatItHasForgotten) {
  // It stays where it is, and is turned away from the ball by something else.
  Striker::Params params{.goal_yaw_rad = 0};
  params.chase.approach_mps = 0;
  Striker striker(params);
  striker.head(0);
  BallSighting ball;
  ball.range_m = 2;
  striker.see(ball);
  striker.step(0);
  striker.head(1);
  striker.see(std::nullopt);
  EXPECT_EQ(striker.step(2'900'000).turn_radps, -params.chase.max_turn_radps);
  EXPECT_EQ(striker.step(3'100'000).turn_radps, params.chase.search_turn_radps);
  EXPECT_THROW(Striker({.behind_m = 0}), std::invalid_argument);
}

}  // namespace
