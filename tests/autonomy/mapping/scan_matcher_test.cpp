// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/scan_matcher.hpp"

#include <gtest/gtest.h>

#include "tests/autonomy/mapping/drawn_room.hpp"

namespace {

using autonomy::OccupancyMap;
using autonomy::Pose2;
using autonomy::ScanMatcher;
using autonomy::Vector2d;

using test::hall_map;
using test::points_of;

/// A long wall, in the middle of cells.
test::DrawnRoom wall_room() {
  test::DrawnRoom room;
  room.walls.push_back({{-50, 3.025}, {50, 3.025}});
  return room;
}

constexpr double to_wall_rad = 1.5;

/// The part of it that beams hit densely.
std::vector<Vector2d> near_points(const test::DrawnRoom& room) {
  std::vector<Vector2d> points;
  for (const Vector2d& point : points_of(room.scan({{0, 0}, to_wall_rad}, 0)))
    if (point.norm() < 5) points.push_back(point);
  return points;
}

OccupancyMap map_of(const std::vector<Vector2d>& points) {
  OccupancyMap map({});
  std::vector<Vector2d> ends;
  for (const Vector2d& point : points) ends.push_back(autonomy::turned(point, to_wall_rad));
  for (int times = 0; times < 3; ++times) map.insert({0, 0}, ends, std::vector<char>(ends.size(), 1), 0);
  return map;
}

/// Information of a prediction with standard deviations.
Eigen::Matrix3d information(double std_m, double std_rad) {
  return Eigen::Vector3d(1 / (std_m * std_m), 1 / (std_m * std_m), 1 / (std_rad * std_rad)).asDiagonal();
}

TEST(ScanMatcher, FindsThePoseOfAScanWithinATenthOfACell) {
  const OccupancyMap map = hall_map();
  const Pose2 truth{{0.5, -0.3}, 0.7};
  const auto points = points_of(test::hall().scan(truth, 0));
  const ScanMatcher matcher({});
  for (const Vector2d& off : {Vector2d(0.15, -0.1), Vector2d(-0.12, 0.17), Vector2d(0, 0)}) {
    const auto match = matcher.match(map, points, {truth.p_W + off, truth.yaw_rad + 0.05}, information(0.1, 0.05));
    // The cells are 0.05 m; the surfaces are anywhere in them, so that half a cell is the most that the field can say.
    EXPECT_LT((match.pose.p_W - truth.p_W).norm(), 0.025);
    EXPECT_NEAR(match.pose.yaw_rad, truth.yaw_rad, 0.005);
    EXPECT_GT(match.score, 0.6);
  }
}

TEST(ScanMatcher, KeepsThePredictionAlongASingleWall) {
  const auto points = near_points(wall_room());
  const auto match = ScanMatcher({}).match(map_of(points), points, {{0.02, 0.15}, to_wall_rad}, information(0.1, 0.05));
  EXPECT_NEAR(match.pose.p_W.y(), 0, 0.025);
  EXPECT_NEAR(match.pose.p_W.x(), 0.02, 0.05);
}

TEST(ScanMatcher, WithoutPointsKeepsThePrediction) {
  const auto match = ScanMatcher({}).match(hall_map(), {}, {{1, 2}, 3}, information(0.1, 0.05));
  EXPECT_EQ(match.pose.p_W, Vector2d(1, 2));
  EXPECT_EQ(match.score, 0);
}

TEST(ScanMatcher, KeepsACertainPredictionAgainstWhatHasMoved) {
  // A pillar before the wall was moved by 0.15 m.
  test::DrawnRoom room = wall_room(), later = wall_room();
  room.add_box({0, 2}, {0.4, 2.4});
  later.add_box({0.15, 2}, {0.55, 2.4});
  const OccupancyMap map = map_of(near_points(room));
  const auto points = near_points(later);
  const Pose2 predicted{{0, 0}, to_wall_rad};
  // It compares with the whole window.
  const ScanMatcher matcher({.good_score = 2});
  EXPECT_NEAR(matcher.match(map, points, predicted, information(0.01, 0.005)).pose.p_W.x(), 0, 0.01);
  // An uncertain one takes the pillar as where it was.
  EXPECT_NEAR(matcher.match(map, points, predicted, information(0.5, 0.05)).pose.p_W.x(), -0.15, 0.03);
}

TEST(ScanMatcher, KnowsWhatAScanSays) {
  const OccupancyMap map = hall_map();
  const Pose2 pose{{0.5, -0.3}, 0.7};
  const auto points = points_of(test::hall().scan(pose, 0));
  const Eigen::Matrix3d hall = ScanMatcher({}).information_of(map, points, pose);
  // A quarter of 180 beams, of which about a half measures each axis to 0.06 m.
  EXPECT_GT(hall(0, 0), 0.2 * 0.25 * 180 / (0.06 * 0.06));
  EXPECT_GT(hall(1, 1), 0.2 * 0.25 * 180 / (0.06 * 0.06));
  EXPECT_LT(hall(0, 0), 0.25 * 180 / (0.06 * 0.06));
  // A single wall says nothing along it.
  const auto of_wall = near_points(wall_room());
  const Eigen::Matrix3d wall = ScanMatcher({}).information_of(map_of(of_wall), of_wall, {{0, 0}, to_wall_rad});
  EXPECT_LT(wall(0, 0), 0.02 * wall(1, 1));
}

}  // namespace
