// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "autonomy/behaviors/avoid_behavior.hpp"
#include "autonomy/behaviors/make_behavior.hpp"
#include "autonomy/behaviors/vector_field_histogram.hpp"
#include "autonomy/behaviors/velocity_obstacles.hpp"
#include "tests/autonomy/behaviors/avoiding_craft.hpp"

namespace {

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
