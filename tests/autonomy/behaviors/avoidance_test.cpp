// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "autonomy/behaviors/avoid_behavior.hpp"
#include "autonomy/behaviors/make_behavior.hpp"
#include "autonomy/behaviors/vector_field_histogram.hpp"
#include "autonomy/behaviors/velocity_obstacles.hpp"
#include "sim/base/math.hpp"
#include "tests/autonomy/second.hpp"

namespace {

using autonomy::AvoidanceLaw;
using autonomy::AvoidanceParams;
using autonomy::Course;
using autonomy::Motion;
using autonomy::Obstacle;
using autonomy::turned;
using autonomy::Vector2d;
using autonomy::VectorFieldHistogram;
using autonomy::VelocityObstacles;
using std::numbers::pi;
using test::second;

constexpr AvoidanceParams params{
    .keep_m = 4, .horizon_s = 15, .turn_radps = 0.3, .speed_time_s = 2, .speed_min_mps = 0};

/// Heads east at 1.5 m/s.
Motion eastwards(const Vector2d& p_W = {0, 0}) {
  return {0, p_W, {1.5, 0}, 0};
}

/// A craft as the laws assume it.
struct AvoidingCraft {
  Motion motion;
  void go(const Course& course) {
    constexpr double dt_s = 0.5;
    motion.yaw_rad += std::clamp(sim::wrap_angle(course.heading_rad - motion.yaw_rad), -0.3 * dt_s, 0.3 * dt_s);
    const double speed_mps = motion.v_W.norm() + (course.speed_mps - motion.v_W.norm()) * dt_s / 2;
    motion.v_W = turned({speed_mps, 0}, motion.yaw_rad);
    motion.p_W += motion.v_W * dt_s;
    motion.utime += second / 2;
  }
};

class EachLaw : public testing::TestWithParam<std::string> {};

TEST_P(EachLaw, ChangesNothingWithoutObstacles) {
  const auto law = autonomy::make_avoidance(GetParam(), params);
  const Course course = law->steer(eastwards(), Vector2d::Zero(), {1.5, 0.2}, {});
  EXPECT_EQ(course.speed_mps, 1.5);
  EXPECT_EQ(course.heading_rad, 0.2);
}

TEST_P(EachLaw, PassesAPileOnItsCourseAtItsDistance) {
  const auto law = autonomy::make_avoidance(GetParam(), params);
  const Obstacle pile{{40, 0.5}, {0, 0}, 1};
  AvoidingCraft craft{eastwards()};
  double nearest_m = 1e9;
  for (int i = 0; i < 120 && craft.motion.p_W.x() < 80; ++i) {
    const Vector2d to_goal_W = Vector2d(120, 0) - craft.motion.p_W;
    craft.go(law->steer(craft.motion, Vector2d::Zero(), {1.5, std::atan2(to_goal_W.y(), to_goal_W.x())}, {{pile}}));
    nearest_m = std::min(nearest_m, (pile.p_W - craft.motion.p_W).norm() - pile.radius_m);
  }
  EXPECT_GT(craft.motion.p_W.x(), 80);
  EXPECT_GT(nearest_m, params.keep_m - 0.5);  // a step of 0.75 m, and directions of 5 or 10 degrees
  EXPECT_LT(nearest_m, 3 * params.keep_m);    // it makes no needless detour
}

TEST_P(EachLaw, TakesTheGapBetweenTwoPiles) {
  const auto law = autonomy::make_avoidance(GetParam(), params);
  // The gap, 14 m wide, is to port.
  const std::vector<Obstacle> piles{{{30, -2}, {0, 0}, 1}, {{30, 16}, {0, 0}, 1}};
  AvoidingCraft craft{eastwards()};
  double nearest_m = 1e9;
  for (int i = 0; i < 100; ++i) {
    const Vector2d to_goal_W = Vector2d(80, 10) - craft.motion.p_W;
    craft.go(law->steer(craft.motion, Vector2d::Zero(), {1.5, std::atan2(to_goal_W.y(), to_goal_W.x())}, piles));
    for (const Obstacle& pile : piles)
      nearest_m = std::min(nearest_m, (pile.p_W - craft.motion.p_W).norm() - pile.radius_m);
  }
  EXPECT_GT(nearest_m, params.keep_m - 0.5);
}

INSTANTIATE_TEST_SUITE_P(Laws, EachLaw, testing::ValuesIn(autonomy::avoidance_names()));

TEST(Avoidance, HasNoLawOfAnotherName) {
  EXPECT_THROW(autonomy::make_avoidance("luck", params), std::invalid_argument);
}

TEST(VelocityObstacles, ComeTooCloseWhenTheirEquationSaysSo) {
  const VelocityObstacles law(params);
  // Head on at 1.5 and 1 m/s from 40 m: 40 - 2.5 t - 1 = 4 at t = 14.
  const Obstacle boat{{40, 0}, {-1, 0}, 1};
  const auto ahead = law.outcome(eastwards(), Vector2d::Zero(), {1.5, 0}, {{boat}});
  EXPECT_NEAR(ahead.collision_s, 14, VelocityObstacles::step_s);
  // Beside it by 6 m: the smallest distance is 6 - 1, a meter more than it keeps.
  const Obstacle beside{{30, 6}, {-1, 0}, 1};
  const auto clear = law.outcome(eastwards(), Vector2d::Zero(), {1.5, 0}, {{beside}});
  EXPECT_TRUE(std::isinf(clear.collision_s));
  EXPECT_NEAR(clear.clearance_m, 1, 0.1);
}

TEST(VelocityObstacles, LetTheWaterCarryTheVehicle) {
  const VelocityObstacles law(params);
  // Heads north through water that sets it east at 1 m/s towards a pile 15 m away: 15 - t - 1 = 4 at t = 10.
  const Motion north{0, {0, 0}, {1, 0}, pi / 2};
  const Obstacle pile{{15, 0}, {0, 0}, 1};
  EXPECT_NEAR(law.outcome(north, {1, 0}, {0, pi / 2}, {{pile}}).collision_s, 10, VelocityObstacles::step_s);
}

TEST(VelocityObstacles, MakeTwoVehiclesThatMeetPassPortToPort) {
  VelocityObstacles east_law(params), west_law(params);
  AvoidingCraft east{eastwards()};
  AvoidingCraft west{{0, {60, 0}, {-1.5, 0}, pi}};
  double nearest_m = 1e9;
  for (int i = 0; i < 70; ++i) {
    const Obstacle west_now{west.motion.p_W, west.motion.v_W, 0.5};
    const Obstacle east_now{east.motion.p_W, east.motion.v_W, 0.5};
    const Course to_east = east_law.steer(east.motion, Vector2d::Zero(), {1.5, 0}, {{west_now}});
    const Course to_west = west_law.steer(west.motion, Vector2d::Zero(), {1.5, pi}, {{east_now}});
    east.go(to_east);
    west.go(to_west);
    const double distance_m = (east.motion.p_W - west.motion.p_W).norm();
    if (distance_m < nearest_m) {
      nearest_m = distance_m;
      // Each has the other to port: the eastbound one is south of the other.
      if (distance_m < 15) {
        EXPECT_LT(east.motion.p_W.y(), west.motion.p_W.y());
      }
    }
  }
  EXPECT_GT(nearest_m, params.keep_m);
  EXPECT_GT(east.motion.p_W.x(), west.motion.p_W.x());
}

TEST(VectorFieldHistogram, BlocksTheSectorsOfAnEnlargedObstacle) {
  const VectorFieldHistogram law(params);
  // 20 m ahead: asin((1 + 4) / 20) = 14.5 degrees to both sides, 2 sectors of 5 degrees.
  const auto blocked = law.blocked(eastwards(), 1.5, 30, {{{{20, 0}, {0, 0}, 1}}});
  for (int i = -3; i <= 3; ++i) EXPECT_EQ(blocked[static_cast<std::size_t>((i + 72) % 72)], std::abs(i) <= 2) << i;
}

TEST(VectorFieldHistogram, BlocksWhatItsTurnDoesNotReach) {
  // At 1.5 m/s and 0.3 rad/s it turns on circles of 5 m: a pile 6 m abeam to port is in the way of a turn to port.
  const VectorFieldHistogram law(params);
  const auto blocked = law.blocked(eastwards(), 1.5, 30, {{{{2, 6}, {0, 0}, 1}}});
  EXPECT_FALSE(blocked[0]);
  EXPECT_TRUE(blocked[24]);   // 120 degrees to port, behind the pile
  EXPECT_FALSE(blocked[54]);  // 90 degrees to starboard
}

TEST(AvoidBehavior, FollowsItsRouteAroundWhatTheScanShows) {
  autonomy::ObstacleTracks::Params tracks;
  tracks.range_m = 50;
  autonomy::AvoidBehavior behavior(autonomy::make_route({{100, 0}}, 1.5, false),
                                   autonomy::Avoidance(autonomy::make_avoidance("velocity_obstacles", params), tracks));
  const Vector2d pile_W(50, 0);
  AvoidingCraft craft{eastwards()};
  craft.motion.utime = second;
  double nearest_m = 1e9;
  for (int i = 0; i < 300 && !behavior.finished(); ++i) {
    // One beam in each degree; the pile has a radius of 1 m.
    autonomy::Scan scan{std::vector<float>(181, 100.0f), -pi / 2, pi / 180};
    const Vector2d d_B = turned(pile_W - craft.motion.p_W, -craft.motion.yaw_rad);
    for (std::size_t k = 0; k < 181; ++k) {
      const Vector2d beam_B = turned({1, 0}, -pi / 2 + static_cast<double>(k) * pi / 180);
      const double along_m = d_B.dot(beam_B);
      if (along_m > 0 && d_B.squaredNorm() - along_m * along_m < 1) scan.ranges_m[k] = static_cast<float>(along_m - 1);
    }
    behavior.receive_scan(scan, craft.motion);
    craft.go(behavior.steer(craft.motion));
    nearest_m = std::min(nearest_m, (craft.motion.p_W - pile_W).norm() - 1);
  }
  EXPECT_TRUE(behavior.finished());
  EXPECT_GT(nearest_m, params.keep_m - 1);
}

TEST(AvoidBehavior, IsCopiedWithItsState) {
  autonomy::AvoidBehavior behavior(autonomy::make_route({{100, 0}}, 1.5, false),
                                   autonomy::Avoidance(autonomy::make_avoidance("velocity_obstacles", params), {}));
  const Motion own{second, {0, 0}, {1.5, 0}, 0};
  autonomy::Scan scan{std::vector<float>(21, 100.0f), -pi / 18, pi / 180};
  for (std::size_t k = 8; k < 13; ++k) scan.ranges_m[k] = 12;
  behavior.receive_scan(scan, own);
  const auto copy = behavior.clone();
  const Course course = behavior.steer(own);
  EXPECT_NE(course.heading_rad, 0);
  const Course again = copy->steer(own);
  EXPECT_EQ(course.heading_rad, again.heading_rad);
  EXPECT_EQ(course.speed_mps, again.speed_mps);
}

}  // namespace
