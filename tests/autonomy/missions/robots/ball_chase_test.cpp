// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/robots/ball_chase.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace {

using autonomy::BallChase;
using autonomy::BallSighting;
using autonomy::ChaseCommand;

BallSighting ball_at(double range_m, double bearing_rad) {
  BallSighting sighting;
  sighting.range_m = range_m;
  sighting.bearing_rad = bearing_rad;
  sighting.pixels = 100;
  return sighting;
}

/// Ticks of 50 ms from 0 on.
class Chased {
 public:
  explicit Chased(const BallChase::Params& params = {}) : chase(params) {}
  ChaseCommand tick() {
    const ChaseCommand command = chase.step(utime);
    utime += 50'000;
    return command;
  }
  ChaseCommand see(const BallSighting& ball) {
    chase.see(ball);
    return tick();
  }
  ChaseCommand see_nothing() {
    chase.see(std::nullopt);
    return tick();
  }

  BallChase chase;
  std::int64_t utime = 0;
};

TEST(BallChase, TurnsOnTheSpotUntilItSeesTheBall) {
  Chased chased({.search_turn_radps = 0.7});
  for (int i = 0; i < 20; ++i) {
    const ChaseCommand command = chased.see_nothing();
    EXPECT_EQ(command.forward_mps, 0);
    EXPECT_EQ(command.turn_radps, 0.7);
  }
  chased.see(ball_at(4, 0));
  EXPECT_EQ(chased.chase.phase(), BallChase::Phase::approach);
}

TEST(BallChase, TurnsInProportionToTheBearingAndSlowsDown) {
  const BallChase::Params p{.turn_gain_per_s = 2, .max_turn_radps = 1, .approach_mps = 1.2, .slow_bearing_rad = 0.6};
  Chased chased(p);
  const ChaseCommand ahead = chased.see(ball_at(4, 0));
  EXPECT_EQ(ahead.forward_mps, 1.2);
  EXPECT_EQ(ahead.turn_radps, 0);
  const ChaseCommand left = chased.see(ball_at(4, 0.3));
  EXPECT_NEAR(left.forward_mps, 0.6, 1e-12);
  EXPECT_NEAR(left.turn_radps, 0.6, 1e-12);
  const ChaseCommand far_right = chased.see(ball_at(4, -0.7));
  EXPECT_EQ(far_right.forward_mps, 0);
  EXPECT_EQ(far_right.turn_radps, -1);
}

TEST(BallChase, GoesStraightOnWhileTheBallIsLostForAMoment) {
  Chased chased({.lost_s = 0.5});
  chased.see(ball_at(4, 0.3));
  for (int i = 0; i < 10; ++i) {  // up to 0.5 s after the sighting
    EXPECT_EQ(chased.see_nothing().turn_radps, 0);
    EXPECT_EQ(chased.chase.phase(), BallChase::Phase::approach);
  }
  chased.see_nothing();
  EXPECT_EQ(chased.chase.phase(), BallChase::Phase::search);
}

TEST(BallChase, SearchesOnTheSideWhereTheBallWasLast) {
  Chased chased({.search_turn_radps = 0.7, .lost_s = 0.1});
  chased.see(ball_at(4, -0.4));
  for (int i = 0; i < 3; ++i) chased.see_nothing();
  EXPECT_EQ(chased.see_nothing().turn_radps, -0.7);
}

TEST(BallChase, DrivesBackAfterAWholeTurnWithoutABall) {
  Chased chased({.search_turn_radps = 2 * std::numbers::pi, .back_s = 0.5, .back_mps = -0.4});
  std::string course;
  for (int i = 0; i < 60; ++i) course += chased.see_nothing().forward_mps < 0 ? 'b' : 't';
  // A turn takes 1 s, at the ticks from 0 to 1 s; then 0.5 s back.
  EXPECT_EQ(course, std::string(21, 't') + std::string(9, 'b') + std::string(21, 't') + std::string(9, 'b'));
}

TEST(BallChase, KicksANearBallAheadAndGoesOnWhenItIsBelowTheCamera) {
  Chased chased({.kick_mps = 1.8, .kick_range_m = 1.2, .kick_bearing_rad = 0.15, .kick_s = 1.5, .lost_s = 0.5});
  chased.see(ball_at(1.1, 0.2));
  EXPECT_EQ(chased.chase.phase(), BallChase::Phase::approach) << "not ahead";
  chased.see(ball_at(1.3, 0));
  EXPECT_EQ(chased.chase.phase(), BallChase::Phase::approach) << "too far";
  EXPECT_EQ(chased.see(ball_at(1.1, 0.1)).forward_mps, 1.8);
  EXPECT_EQ(chased.chase.kicks(), 1);
  for (int i = 0; i < 30; ++i) {  // 1.5 s
    EXPECT_EQ(chased.see_nothing().forward_mps, 1.8);
    EXPECT_EQ(chased.chase.phase(), BallChase::Phase::kick);
  }
  chased.see_nothing();
  EXPECT_EQ(chased.chase.phase(), BallChase::Phase::search);
  EXPECT_EQ(chased.chase.kicks(), 1);
}

TEST(BallChase, FollowsABallThatItKicked) {
  Chased chased({.kick_range_m = 1.2, .kick_s = 0.2});
  chased.see(ball_at(1, 0));
  for (int i = 0; i < 5; ++i) chased.see(ball_at(3, 0));
  EXPECT_EQ(chased.chase.phase(), BallChase::Phase::approach);
}

TEST(BallChase, CorrectsALateBearingByTheTurnsSinceTheImage) {
  Chased chased({.turn_gain_per_s = 2, .max_turn_radps = 1, .predict = true});
  BallSighting ball = ball_at(4, 0.3);
  ball.utime = 0;
  EXPECT_NEAR(chased.see(ball).turn_radps, 0.6, 1e-12);
  // It has turned by 0.6 rad/s for 50 ms when the same image comes again.
  EXPECT_NEAR(chased.see(ball).turn_radps, 2 * (0.3 - 0.6 * 0.05), 1e-12);
  // An image in the middle of the last tick: the second turn acted for 25 ms.
  ball.utime = 75'000;
  EXPECT_NEAR(chased.see(ball).turn_radps, 2 * (0.3 - 0.54 * 0.025), 1e-12);
}

TEST(BallChase, RefusesGainsOfZero) {
  EXPECT_THROW(BallChase({.turn_gain_per_s = 0}), std::invalid_argument);
  EXPECT_THROW(BallChase({.kick_s = std::nan("")}), std::invalid_argument);
}

}  // namespace
