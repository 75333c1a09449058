// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/mapping/place_search.hpp"

#include <gtest/gtest.h>

#include "sim/base/math.hpp"
#include "tests/autonomy/mapping/drawn_room.hpp"

namespace {

using autonomy::Beams;
using autonomy::OccupancyMap;
using autonomy::PlaceSearch;
using autonomy::Pose2;
using autonomy::Vector2d;

Beams beams_of(const shoal::planar_lidar_t& scan) {
  Beams beams;
  beams.points_B = beams.ends_B = test::points_of(scan);
  beams.hits.assign(beams.ends_B.size(), 1);
  return beams;
}

/// Turns on the spot by 0.4 rad between scans, of which odometry measures 2 % too much.
std::optional<Pose2> search(const test::DrawnRoom& room, const OccupancyMap& map, Pose2& truth, int scans) {
  PlaceSearch search({});
  const autonomy::ScanMatcher matcher({});
  for (int i = 0; i < scans; ++i) {
    if (const auto found = search.look(map, matcher, beams_of(room.scan(truth, 0)), {})) return found;
    constexpr double turn_rad = 0.4;
    truth.yaw_rad = sim::wrap_angle(truth.yaw_rad + turn_rad);
    search.move({0, 0, 1.02 * turn_rad});
  }
  return std::nullopt;
}

TEST(PlaceSearch, FindsAVehicleAnywhereInTheHall) {
  const OccupancyMap map = test::hall_map();
  for (Pose2 truth : {Pose2{{-4, -3}, 0.4}, Pose2{{6.5, 3.5}, -2.2}, Pose2{{1, 1}, 3.0}}) {
    const auto found = search(test::hall(), map, truth, 6);
    ASSERT_TRUE(found);
    EXPECT_LT((found->p_W - truth.p_W).norm(), 0.1);
    EXPECT_LT(std::abs(sim::wrap_angle(found->yaw_rad - truth.yaw_rad)), 0.03);
  }
}

TEST(PlaceSearch, DoesNotChooseBetweenTwoEqualPlaces) {
  // A hall of two equal rooms, 8 m apart, so that even their cells are equal.
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
      for (const Vector2d& point : test::points_of(rooms.scan({{x, 0}, yaw_rad}, 0)))
        ends.push_back(Vector2d(x, 0) + autonomy::turned(point, yaw_rad));
      for (int times = 0; times < 3; ++times) map.insert({x, 0}, ends, std::vector<char>(ends.size(), 1), 0);
    }
  Pose2 truth{{-4, 0}, 0.2};
  EXPECT_FALSE(search(rooms, map, truth, 18));
}

TEST(PlaceSearch, FindsNothingInAnEmptyMap) {
  Pose2 truth;
  EXPECT_FALSE(search(test::hall(), OccupancyMap({}), truth, 5));
  EXPECT_FALSE(search({}, test::hall_map(), truth, 5));  // a lidar that sees nothing
}

TEST(PlaceSearch, AFitCountsWhatContradictsTheMap) {
  const OccupancyMap map = test::hall_map();
  const Pose2 truth{{0.5, -0.3}, 0.7};
  const Beams beams = beams_of(test::hall().scan(truth, 0));
  EXPECT_GT(autonomy::fit_of(map, beams, truth).near, 0.95);
  EXPECT_NEAR(autonomy::fit_of(map, beams, truth, 0.25).near, 0.25, 0.02);
  EXPECT_LT(autonomy::fit_of(map, beams, {{0.5, -0.3}, 2.2}).evidence(), 0.2);
  EXPECT_EQ(autonomy::fit_of(OccupancyMap({}), beams, truth).evidence(), 0);  // all is unknown
}

}  // namespace
