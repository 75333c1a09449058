// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/scan_alignment.hpp"

#include <gtest/gtest.h>

#include "autonomy/mapping/pose_graph.hpp"
#include "tests/autonomy/mapping/drawn_room.hpp"

namespace {

using autonomy::Outline;
using autonomy::Pose2;
using autonomy::Vector2d;

TEST(ScanAlignment, FindsTheMotionBetweenTwoScans) {
  const Pose2 a{{-3, -1}, 0.3}, b{{-2.5, -0.9}, 0.55};
  const Outline from(test::points_of(test::hall().scan(a, 0))), to(test::points_of(test::hall().scan(b, 0)));
  const Pose2 truth = autonomy::seen_from(a, b);
  const auto aligned = autonomy::align(from, to, {truth.p_W + Vector2d(0.2, -0.15), truth.yaw_rad - 0.03}, 0.4);
  ASSERT_TRUE(aligned);
  // Without noise; points near corners are on no line.
  EXPECT_LT((aligned->pose.p_W - truth.p_W).norm(), 0.005);
  EXPECT_NEAR(aligned->pose.yaw_rad, truth.yaw_rad, 0.001);
}

TEST(ScanAlignment, AlongASingleWallKeepsTheGuessAndSaysSo) {
  test::DrawnRoom room;
  room.walls.push_back({{-50, 3}, {50, 3}});
  const Pose2 a{{0, 0}, 1.5}, b{{1, 0.1}, 1.5};
  const Outline from(test::points_of(room.scan(a, 0))), to(test::points_of(room.scan(b, 0)));
  Pose2 guess = autonomy::seen_from(a, b);
  guess.p_W += autonomy::turned(Vector2d(0.1, 0.1), -1.5);  // by as much along the wall as across
  const auto aligned = autonomy::align(from, to, guess, 0.4);
  ASSERT_TRUE(aligned);
  const Vector2d off_W = autonomy::turned(aligned->pose.p_W - autonomy::seen_from(a, b).p_W, 1.5);
  EXPECT_NEAR(off_W.x(), 0.1, 0.02);
  EXPECT_NEAR(off_W.y(), 0, 0.005);
  const Eigen::Matrix2d information = aligned->information.topLeftCorner<2, 2>();
  const Vector2d along = autonomy::turned(Vector2d(1, 0), -1.5), across = autonomy::left_of(along);
  EXPECT_LT(along.dot(information * along), 1e-3 * across.dot(information * across));
}

TEST(ScanAlignment, OfDifferentRoomsIsNone) {
  test::DrawnRoom other;
  other.add_box({-1, -1}, {1, 2});
  const Outline hall(test::points_of(test::hall().scan({}, 0))), room(test::points_of(other.scan({}, 0)));
  EXPECT_FALSE(autonomy::align(hall, room, {}, 0.4));
  EXPECT_FALSE(autonomy::align(hall, Outline(), {}, 0.4));
  EXPECT_FALSE(autonomy::align(Outline(), hall, {}, 0.4));
}

}  // namespace
