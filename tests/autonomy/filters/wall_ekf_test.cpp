// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/filters/wall_ekf.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using autonomy::first_wall;
using autonomy::Vector2d;
using autonomy::Wall;
using autonomy::WallEkf;
using std::numbers::pi;

const std::vector<Wall> corner = {{{-100, 30}, {100, 30}}, {{100, -100}, {100, 30}}};

TEST(FirstWall, IsTheNearestOneThatTheBeamMeets) {
  const auto ahead = first_wall(corner, {10, 0}, pi / 2, 1);
  ASSERT_TRUE(ahead);
  EXPECT_NEAR(ahead->range_m, 30, 1e-12);
  EXPECT_NEAR(ahead->normal_W.y(), -1, 1e-12);
  // At 45 degrees from (40, 0): the north wall after 30 sqrt(2), before the east wall.
  EXPECT_NEAR(first_wall(corner, {40, 0}, pi / 4, 1)->range_m, 30 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(first_wall(corner, {90, 0}, pi / 4, 1)->range_m, 10 * std::sqrt(2.0), 1e-12);
  EXPECT_FALSE(first_wall(corner, {10, 0}, -pi / 2, 1));
  // Half a meter from the end of the wall.
  EXPECT_FALSE(first_wall(corner, {-99.5, 0}, pi / 2, 1));
}

TEST(WallEkf, DeadReckonsWithHeadingAndSpeed) {
  WallEkf filter({5, 5}, 1, pi / 2, 0.01, {});
  for (int i = 0; i < 100; ++i) filter.predict(0.1, 0, 1.5);
  EXPECT_NEAR(filter.p_W().x(), 5, 1e-9);
  EXPECT_NEAR(filter.p_W().y(), 20, 1e-9);
  // sqrt(1 + (0.3 * 10)^2 + ...): most of it is the unknown current.
  EXPECT_NEAR(std::sqrt(filter.position_covariance()(1, 1)), std::hypot(1, 3), 0.05);
}

TEST(WallEkf, ARangeCorrectsTheDistanceToItsWallOnly) {
  WallEkf filter({0, 2}, 3, pi / 2, 1e-6, {});
  // In truth at (0, 0): 30 - 0.7 m to the wall ahead.
  ASSERT_TRUE(filter.update_range(corner, 0, 0, 0.7, 29.3, 0.05));
  EXPECT_NEAR(filter.p_W().y(), 0, 0.01);
  EXPECT_NEAR(filter.p_W().x(), 0, 1e-9);
  EXPECT_LT(std::sqrt(filter.position_covariance()(1, 1)), 0.06);
  EXPECT_NEAR(std::sqrt(filter.position_covariance()(0, 0)), 3, 1e-3);
}

TEST(WallEkf, RefusesARangeThatContradictsIt) {
  WallEkf filter({0, 0}, 0.5, pi / 2, 1e-3, {});
  EXPECT_FALSE(filter.update_range(corner, 0, 0, 0.7, 20, 0.05));  // something before the wall
  EXPECT_EQ(filter.p_W().y(), 0);
}

/// The derivatives are those of the range that the geometry gives.
TEST(WallEkf, FindsTheHeadingByTwoBeamsToOneWall) {
  const double error_rad = 0.03;
  WallEkf filter({0, 0}, 1, pi / 2 + error_rad, 0.1, {});
  // True ranges of beams 40 degrees to both sides of a bow that points north, from (0, 0).
  for (int i = 0; i < 20; ++i)
    for (const double beam_rad : {-0.7, 0.7})
      filter.update_range(corner, 0, beam_rad, 0.7, (30 - 0.7) / std::cos(beam_rad), 0.05);
  EXPECT_NEAR(filter.yaw_rad(0), pi / 2, 0.002);
  EXPECT_NEAR(filter.p_W().y(), 0, 0.05);
}

TEST(WallEkf, FindsCurrentAndHeadingOnARouteWithATurn) {
  const Vector2d current_W(0.1, -0.05);
  const double offset_rad = 0.4;
  WallEkf filter({0, 0}, 0.5, offset_rad + 0.2, 0.3, {});
  Vector2d p_W(0, 0);
  for (int i = 0; i < 900; ++i) {
    const double gyro_rad = i < 450 ? 0.0 : pi / 2;
    p_W += (autonomy::turned({1.2, 0}, gyro_rad + offset_rad) + current_W) * 0.1;
    filter.predict(0.1, gyro_rad, 1.2);
    if (i % 10 == 0) filter.update_position(p_W, 0.5);
  }
  EXPECT_NEAR(filter.yaw_rad(0), offset_rad, 0.02);
  EXPECT_NEAR(filter.current_W().x(), current_W.x(), 0.02);
  EXPECT_NEAR(filter.current_W().y(), current_W.y(), 0.02);
}

}  // namespace
