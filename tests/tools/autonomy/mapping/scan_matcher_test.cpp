// SPDX-License-Identifier: BSD-3-Clause
#include "tools/autonomy/mapping/scan_matcher.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/base/math.hpp"
#include "tests/tools/autonomy/mapping/drawn_room.hpp"

namespace {

using autonomy::OccupancyMap;
using autonomy::Pose2;
using autonomy::ScanMatcher;
using autonomy::Vector2d;

std::vector<Vector2d> points_of(const shoal::planar_lidar_t& scan) {
  std::vector<Vector2d> points;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double angle = static_cast<double>(scan.rad0) + static_cast<double>(i) * static_cast<double>(scan.radstep);
    if (scan.ranges[i] < 19.9F)
      points.emplace_back(static_cast<double>(scan.ranges[i]) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

std::vector<autonomy::Sight> sights_of(const shoal::planar_lidar_t& scan) {
  std::vector<autonomy::Sight> sights;
  for (const Vector2d& point : points_of(scan)) sights.push_back({Vector2d::Zero(), point});
  return sights;
}

/// The map of the hall, seen from many places.
OccupancyMap hall_map() {
  OccupancyMap::Params params;
  params.low_W = {-9, -6};
  params.high_W = {9, 6};
  OccupancyMap map(params);
  for (const Vector2d& from : {Vector2d(-6, -2), Vector2d(0, 0), Vector2d(6, -1), Vector2d(3, 3), Vector2d(-6, 3)})
    for (const double yaw_rad : {0.0, 1.5, 3.0, 4.5}) {
      std::vector<Vector2d> ends;
      for (const Vector2d& point : points_of(test::hall().scan({from, yaw_rad}, 0)))
        ends.push_back(from + autonomy::turned(point, yaw_rad));
      for (int times = 0; times < 3; ++times) map.insert(from, ends, std::vector<char>(ends.size(), 1), 0);
    }
  return map;
}

TEST(ScanMatcher, FindsThePoseOfAScanWithinATenthOfACell) {
  const OccupancyMap map = hall_map();
  const Pose2 truth{{0.5, -0.3}, 0.7};
  const auto points = points_of(test::hall().scan(truth, 0));
  const ScanMatcher matcher({});
  for (const Vector2d& off : {Vector2d(0.15, -0.1), Vector2d(-0.12, 0.17), Vector2d(0, 0)}) {
    const auto match = matcher.match(map, points, {truth.p_W + off, truth.yaw_rad + 0.05});
    // The cells are 0.05 m; the surfaces are anywhere in them, so that half a cell is the most that the field can say.
    EXPECT_LT((match.pose.p_W - truth.p_W).norm(), 0.025);
    EXPECT_NEAR(match.pose.yaw_rad, truth.yaw_rad, 0.005);
    EXPECT_GT(match.score, 0.6);
  }
}

TEST(ScanMatcher, KeepsThePredictionAlongASingleWall) {
  test::DrawnRoom room;
  room.walls.push_back({{-50, 3}, {50, 3}});
  OccupancyMap::Params params;
  OccupancyMap map(params);
  const auto points = points_of(room.scan({{0, 0}, 1.5}, 0));
  std::vector<Vector2d> ends;
  for (const Vector2d& point : points) ends.push_back(autonomy::turned(point, 1.5));
  map.insert({0, 0}, ends, std::vector<char>(ends.size(), 1), 0);
  map.insert({0, 0}, ends, std::vector<char>(ends.size(), 1), 0);
  const auto match = ScanMatcher({}).match(map, points, {{0.02, 0.15}, 1.5});
  EXPECT_NEAR(match.pose.p_W.y(), 0, 0.025);
  EXPECT_NEAR(match.pose.p_W.x(), 0.02, 0.05);
}

TEST(ScanMatcher, WithoutPointsKeepsThePrediction) {
  const auto match = ScanMatcher({}).match(hall_map(), {}, {{1, 2}, 3});
  EXPECT_EQ(match.pose.p_W, Vector2d(1, 2));
  EXPECT_EQ(match.score, 0);
}

TEST(SearchMap, FindsAScanAnywhereInTheHall) {
  const OccupancyMap map = hall_map();
  for (const Pose2& truth : {Pose2{{-4, -3}, 0.4}, Pose2{{6.5, 3.5}, -2.2}, Pose2{{1, 1}, 3.0}}) {
    const auto found = autonomy::search_map(map, sights_of(test::hall().scan(truth, 0)), 0.4);
    ASSERT_TRUE(found);
    EXPECT_LT((found->best.pose.p_W - truth.p_W).norm(), 0.1);
    EXPECT_LT(std::abs(sim::wrap_angle(found->best.pose.yaw_rad - truth.yaw_rad)), 0.03);
    EXPECT_LT(found->other_score, found->best.score);
  }
}

TEST(SearchMap, OfTwoEqualPlacesSaysSo) {
  // A hall of two equal rooms, 8 m apart; the scan shows one of them.
  test::DrawnRoom rooms;
  for (const double x : {-4.0, 4.0}) {
    rooms.add_box({x - 3, -2}, {x + 3, 2});
    rooms.add_box({x - 2, 0.5}, {x - 1, 1});
  }
  OccupancyMap::Params params;
  params.low_W = {-9, -6};
  params.high_W = {9, 6};
  OccupancyMap map(params);
  for (const double x : {-4.0, 4.0})
    for (const double yaw_rad : {0.0, 1.5, 3.0, 4.5}) {
      std::vector<Vector2d> ends;
      for (const Vector2d& point : points_of(rooms.scan({{x, 0}, yaw_rad}, 0)))
        ends.push_back(Vector2d(x, 0) + autonomy::turned(point, yaw_rad));
      for (int times = 0; times < 3; ++times) map.insert({x, 0}, ends, std::vector<char>(ends.size(), 1), 0);
    }
  const auto found = autonomy::search_map(map, sights_of(rooms.scan({{-4, 0}, 0.2}, 0)), 0.4);
  ASSERT_TRUE(found);
  // The rooms are 160 cells apart, so that even their cells are equal.
  EXPECT_NEAR(found->other_score, found->best.score, 0.05);
}

TEST(SearchMap, FindsNothingInAnEmptyMap) {
  EXPECT_FALSE(autonomy::search_map(OccupancyMap({}), sights_of(test::hall().scan({}, 0)), 0.4));
  EXPECT_FALSE(autonomy::search_map(hall_map(), {}, 0.4));
}

}  // namespace
