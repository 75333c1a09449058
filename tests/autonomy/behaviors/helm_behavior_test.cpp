// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/helm_behavior.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "autonomy/behaviors/make_behavior.hpp"
#include "sim/base/math.hpp"

namespace {

using autonomy::CircleBehavior;
using autonomy::Course;
using autonomy::FollowBehavior;
using autonomy::HoldBehavior;
using autonomy::Motion;
using autonomy::RouteBehavior;
using autonomy::turned;
using autonomy::Vector2d;
using test::second;

/// A craft that turns at 0.3 rad/s at most, and takes the speed it is commanded.
class Craft {
 public:
  explicit Craft(const Vector2d& p_W, double yaw_rad = 0) : yaw_rad_(yaw_rad) { motion_.p_W = p_W; }
  void go(const Course& course, const Vector2d& current_W = Vector2d::Zero()) {
    constexpr double dt_s = 0.5;
    yaw_rad_ += std::clamp(sim::wrap_angle(course.heading_rad - yaw_rad_), -0.3 * dt_s, 0.3 * dt_s);
    motion_.v_W = turned({course.speed_mps, 0}, yaw_rad_) + current_W;
    motion_.p_W += motion_.v_W * dt_s;
    motion_.utime += second / 2;
  }
  const Motion& motion() const { return motion_; }

 private:
  Motion motion_;
  double yaw_rad_;
};

TEST(RouteBehavior, GoesToItsWaypointsInTurnAndStops) {
  RouteBehavior route({{100, 0}, {100, 50}, {0, 50}}, {});
  Craft craft({0, 0});
  std::vector<std::size_t> seen;
  for (int i = 0; i < 1000 && !route.finished(); ++i) {
    craft.go(route.steer(craft.motion()));
    if (seen.empty() || seen.back() != route.current()) seen.push_back(route.current());
  }
  EXPECT_EQ(seen, (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_LT((craft.motion().p_W - Vector2d(0, 50)).norm(), 6);
  EXPECT_EQ(route.steer(craft.motion()).speed_mps, 0);
}

TEST(RouteBehavior, ComesOntoItsLeg) {
  RouteBehavior route({{500, 0}}, {});
  Craft craft({0, 0});
  route.steer(craft.motion());
  Craft beside({10, 30});
  for (int i = 0; i < 200; ++i) beside.go(route.steer(beside.motion()));
  EXPECT_NEAR(beside.motion().p_W.y(), 0, 0.1);
}

TEST(RouteBehavior, CurrentAcrossLeavesTheOffsetItSays) {
  RouteBehavior::Params params;
  RouteBehavior route({{2000, 0}}, params);
  Craft craft({0, 0});
  for (int i = 0; i < 600; ++i) craft.go(route.steer(craft.motion()), {0, 0.3});
  // In the end its speed across is that of the current: sin(heading) = -0.3 / 1.5.
  EXPECT_NEAR(craft.motion().p_W.y(), params.lookahead_m * std::tan(std::asin(0.2)), 0.02);
}

TEST(RouteBehavior, TurnsNotBackForAWaypointThatWasMissed) {
  RouteBehavior route({{50, 0}, {200, 0}}, {});
  Motion motion;
  route.steer(motion);
  motion.p_W = {51, 20};
  route.steer(motion);
  EXPECT_EQ(route.current(), 1u);
}

TEST(RouteBehavior, LoopsForEver) {
  RouteBehavior::Params params;
  params.loop = true;
  RouteBehavior route({{60, 0}, {60, 60}, {0, 0}}, params);
  Craft craft({0, 0});
  int starts = 0;
  std::size_t before = 0;
  for (int i = 0; i < 2000; ++i) {
    craft.go(route.steer(craft.motion()));
    if (route.current() < before) ++starts;
    before = route.current();
  }
  EXPECT_FALSE(route.finished());
  EXPECT_GE(starts, 6);  // 1500 m of rounds of 205 m
}

TEST(RouteBehavior, RouteOfOnePointInALoopDoesNotHang) {
  RouteBehavior::Params params;
  params.loop = true;
  RouteBehavior route({{0, 0}, {0, 0}}, params);
  EXPECT_TRUE(std::isfinite(route.steer({}).heading_rad));
}

TEST(CircleBehavior, GoesRoundCounterClockwise) {
  CircleBehavior::Params params;
  params.center_W = {100, 50};
  params.radius_m = 40;
  for (const Vector2d& start : {Vector2d(0, 0), Vector2d(100, 50), Vector2d(300, 300)}) {
    CircleBehavior circle(params);
    Craft craft(start);
    for (int i = 0; i < 600; ++i) craft.go(circle.steer(craft.motion()));
    for (int i = 0; i < 200; ++i) {
      craft.go(circle.steer(craft.motion()));
      const Vector2d d_W = craft.motion().p_W - params.center_W;
      EXPECT_NEAR(d_W.norm(), 40, 2);
      EXPECT_GT(d_W.x() * craft.motion().v_W.y() - d_W.y() * craft.motion().v_W.x(), 0);
    }
  }
}

TEST(HoldBehavior, GoesStraightToThePlaceAndStaysOnItsCircle) {
  HoldBehavior hold({.center_W = {300, -100}, .radius_m = 30, .speed_mps = 1.5});
  Craft craft({0, 0});
  double off_line_m = 0;
  int steps = 0;
  for (; steps < 1000 && (craft.motion().p_W - Vector2d(300, -100)).norm() > 6; ++steps) {
    craft.go(hold.steer(craft.motion()));
    off_line_m = std::max(off_line_m, std::abs(turned(craft.motion().p_W, std::atan2(100, 300)).y()));
  }
  EXPECT_NEAR(0.5 * steps, std::hypot(300, 100) / 1.5, 5);  // s on the straight line
  EXPECT_LT(off_line_m, 2);
  for (int i = 0; i < 1000; ++i) {
    craft.go(hold.steer(craft.motion()));
    if (i < 200) continue;
    EXPECT_NEAR((craft.motion().p_W - Vector2d(300, -100)).norm(), 30, 2);
  }
  EXPECT_FALSE(hold.finished());
}

TEST(FollowBehavior, KeepsItsPlaceBesideTheOther) {
  FollowBehavior::Params params;
  params.vehicle = "auv";
  params.ahead_m = -10;
  params.left_m = 30;
  FollowBehavior follow(params);
  Craft craft({-150, -80});
  EXPECT_EQ(follow.steer(craft.motion()).speed_mps, 0);  // it has received nothing
  Motion auv;
  auv.v_W = {0, 1.2};
  for (int i = 0; i < 1200; ++i) {
    auv.utime = craft.motion().utime;
    if (i % 60 == 0) follow.receive_state("auv", auv);  // twice a minute
    follow.receive_state("boat2", craft.motion());
    craft.go(follow.steer(craft.motion()));
    auv.p_W += 0.5 * auv.v_W;
  }
  // Its course is north: left is west.
  EXPECT_NEAR(craft.motion().p_W.x(), -30, 1);
  EXPECT_NEAR(craft.motion().p_W.y(), auv.p_W.y() - 10, 2);
}

TEST(FollowBehavior, GoesToAPlaceBesideOneThatStandsStill) {
  FollowBehavior::Params params;
  params.vehicle = "auv";
  FollowBehavior follow(params);
  follow.receive_state("auv", {});
  Craft craft({100, 0});
  for (int i = 0; i < 300; ++i) craft.go(follow.steer(craft.motion()));
  EXPECT_LT((craft.motion().p_W - Vector2d(0, 30)).norm(), 16);
}

TEST(FollowBehavior, ForgetsWhatIsOld) {
  FollowBehavior::Params params;
  params.vehicle = "auv";
  FollowBehavior follow(params);
  Motion auv;
  auv.utime = 10 * second;
  auv.v_W = {1, 0};
  follow.receive_state("auv", auv);
  Motion older = auv;
  older.utime = 5 * second;
  older.p_W = {1000, 1000};
  follow.receive_state("auv", older);
  EXPECT_NEAR((*follow.place_W(20 * second) - Vector2d(10, 30)).norm(), 0, 1e-9);
  EXPECT_FALSE(follow.place_W(311 * second));
}

TEST(FollowBehavior, SaysWhomItNeverReceived) {
  FollowBehavior::Params params;
  params.vehicle = "nobody";
  FollowBehavior follow(params);
  follow.receive_state("auv", {});
  EXPECT_EQ(follow.remark(), "it has received no message from 'nobody', which it was to follow");
  follow.receive_state("nobody", {});
  EXPECT_EQ(follow.remark(), "");
}

TEST(FollowBehavior, ListensToOneWhoseClockWasSetBack) {
  FollowBehavior::Params params;
  params.vehicle = "auv";
  FollowBehavior follow(params);
  Motion auv;
  auv.utime = 3700 * second;
  auv.v_W = {1, 0};
  follow.receive_state("auv", auv);
  EXPECT_FALSE(follow.place_W(100 * second));  // its own clock was set back, and the news are of the old time
  auv.utime = 100 * second;
  auv.p_W = {50, 0};
  follow.receive_state("auv", auv);
  EXPECT_NEAR((*follow.place_W(110 * second) - Vector2d(60, 30)).norm(), 0, 1e-9);
}

TEST(Zigzag, CrossesItsLine) {
  const auto points = autonomy::zigzag({0, 0}, {400, 0}, 20, 4);
  const std::vector<Vector2d> expected = {{50, 20}, {150, -20}, {250, 20}, {350, -20}, {400, 0}};
  ASSERT_EQ(points.size(), expected.size());
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR((points[i] - expected[i]).norm(), 0, 1e-9);
}

}  // namespace
