// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/avoid_behavior.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "autonomy/behaviors/make_behavior.hpp"
#include "autonomy/behaviors/vector_field_histogram.hpp"
#include "autonomy/behaviors/velocity_obstacles.hpp"
#include "tests/autonomy/behaviors/avoiding_craft.hpp"

namespace {

using namespace avoiding_craft;

using autonomy::Course;
using autonomy::Motion;
using autonomy::turned;
using autonomy::Vector2d;
using std::numbers::pi;
using test::second;

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

using namespace avoiding_craft;

using autonomy::Course;
using autonomy::Obstacle;
using autonomy::Vector2d;

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

}  // namespace
