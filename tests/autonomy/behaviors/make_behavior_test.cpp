// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/make_behavior.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "autonomy/behaviors/helm_behavior.hpp"

namespace {

using autonomy::CircleBehavior;
using autonomy::FollowBehavior;
using autonomy::make_circle;
using autonomy::make_follow;
using autonomy::make_route;
using autonomy::make_zigzag;
using autonomy::RouteBehavior;

TEST(MakeBehavior, MakesEachBehavior) {
  EXPECT_NE(dynamic_cast<RouteBehavior*>(make_route({{1, 2}}, 1, false).get()), nullptr);
  EXPECT_NE(dynamic_cast<RouteBehavior*>(make_zigzag({0, 0}, {400, 0}, 20, 4, 1, false).get()), nullptr);
  EXPECT_NE(dynamic_cast<CircleBehavior*>(make_circle({1, 2}, 30, 1).get()), nullptr);
  EXPECT_NE(dynamic_cast<FollowBehavior*>(make_follow("auv", -10, 30, 1).get()), nullptr);
}

TEST(MakeBehavior, RefusesWhatCannotBeSteered) {
  EXPECT_THROW(make_route({}, 1, false), std::invalid_argument);
  for (const double radius_m : {0.0, -1.0, std::nan("")})
    EXPECT_THROW(make_circle({1, 2}, radius_m, 1), std::invalid_argument) << radius_m;
  for (const int legs : {0, 1001}) EXPECT_THROW(make_zigzag({0, 0}, {1, 1}, 5, legs, 1, false), std::invalid_argument);
}

}  // namespace
