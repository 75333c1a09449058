// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/known_map/path_search.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "shoal/message_codec.hpp"
#include "tests/autonomy/known_map/flat_map.hpp"

namespace {

using autonomy::Path;
using autonomy::PathCosts;
using autonomy::PlanGrid;
using autonomy::Vector2d;
using testing::HasSubstr;

PlanGrid grid_of(const shoal::occupancy_grid_t& map) {
  PlanGrid grid{autonomy::frame_of(map), {}, {}};
  std::vector<char> occupied;
  for (const std::int8_t percent : map.cells) {
    occupied.push_back(percent == 100 ? 1 : 0);
    grid.unknown.push_back(percent < 0 ? 1 : 0);
  }
  grid.clearance_m = autonomy::distances_m(grid.frame, occupied);
  return grid;
}

double length_m(const Path& path) {
  double sum_m = 0;
  for (std::size_t i = 1; i < path.points_W.size(); ++i) sum_m += (path.points_W[i] - path.points_W[i - 1]).norm();
  return sum_m;
}

/// Smallest clearance along a path.
double clearance_m(const PlanGrid& grid, const Path& path) {
  double min_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < path.points_W.size(); ++i)
    for (int k = 0; k <= 1000; ++k)
      min_m = std::min(min_m,
                       grid.clearance_at(path.points_W[i - 1] + 1e-3 * k * (path.points_W[i] - path.points_W[i - 1])));
  return min_m;
}

/// A box of 4 x 2 m in the middle of a free ground of 20 x 20 m.
shoal::occupancy_grid_t one_box() {
  shoal::occupancy_grid_t map = test::flat_map({-10, -10}, {10, 10}, 0.1);
  test::set_box(map, {-2, -1}, {2, 1});
  return map;
}

/// Length of the shortest path from (-a, 0) to (a, 0) that stays r from a box of half width w and half height h:
/// straight to a tangent of the circle of radius r about a corner, along its arc, along the side, and symmetrically on.
double shortest_m(double a, double w, double h, double r) {
  const double d = std::hypot(a - w, h);
  const double tangent_m = std::sqrt(d * d - r * r);
  // The radius to the point of contact, from north: the direction of the tangent, from east.
  const double climbs_rad = std::atan2(h, a - w) + std::asin(r / d);
  return 2 * (tangent_m + r * climbs_rad + w);
}

TEST(PathSearch, IsAsLongAsTheShortestPathAroundABox) {
  const PlanGrid grid = grid_of(one_box());
  PathCosts costs;
  costs.clearance_cost = 0;
  for (const double keep_m : {0.3, 0.6, 1.5}) {
    costs.keep_m = costs.prefer_m = keep_m;
    const Path path = search_path(grid, {-7, 0}, {7, 0}, costs);
    ASSERT_FALSE(path.points_W.empty()) << path.why_none;
    // Clearances are between centers of cells: the border of the box is half a cell nearer, and a point in a cell up to
    // the half of its diagonal.
    const double optimum_m = shortest_m(7, 2, 1, keep_m);
    EXPECT_LT(length_m(path), 1.02 * optimum_m) << keep_m;
    EXPECT_GT(length_m(path), shortest_m(7, 2, 1, keep_m - 0.05 - 0.0708)) << keep_m;
    EXPECT_GE(clearance_m(grid, path), keep_m - 0.0708) << keep_m;
  }
}

TEST(PathSearch, IsStraightOnFreeGround) {
  const PlanGrid grid = grid_of(test::flat_map({-10, -10}, {10, 10}, 0.1));
  const Path path = search_path(grid, {-8.03, -2.01}, {7.77, 5.55}, {});
  ASSERT_EQ(path.points_W.size(), 2U);
  EXPECT_EQ(path.points_W[0], Vector2d(-8.03, -2.01));
  EXPECT_EQ(path.points_W[1], Vector2d(7.77, 5.55));
}

TEST(PathSearch, GoesInTheMiddleOfACorridorAndTakesALongerPathThatIsWider) {
  // A wall with a gap of 1.4 m ahead, and one of 4 m, 3 m aside: by the narrow one it comes to 0.7 m from both sides.
  shoal::occupancy_grid_t map = test::flat_map({-10, -10}, {10, 10}, 0.1);
  test::set_box(map, {-0.5, -10}, {0.5, -0.7});
  test::set_box(map, {-0.5, 0.7}, {0.5, 1.5});
  test::set_box(map, {-0.5, 5.5}, {0.5, 10});
  const PlanGrid grid = grid_of(map);
  PathCosts costs;
  costs.prefer_m = 1.5;
  costs.clearance_cost = 0;
  const Path narrow = search_path(grid, {-4, 0}, {4, 0}, costs);
  ASSERT_FALSE(narrow.points_W.empty());
  EXPECT_LT(length_m(narrow), 8.1);
  EXPECT_GE(clearance_m(grid, narrow), costs.keep_m - 0.0708);
  // Two legs of 4 m that climb 2.5 m are 9.5 m; about 2 m near the narrow gap cost up to 5 times as much.
  costs.clearance_cost = 8;
  const Path wide = search_path(grid, {-4, 0}, {4, 0}, costs);
  EXPECT_GT(length_m(wide), 9);
  EXPECT_GT(clearance_m(grid, wide), 1);
}

TEST(PathSearch, EntersUnknownGroundWhenThatIsShorterByMoreThanItCosts) {
  // A wall with an opening on unknown ground ahead, and one on known ground far aside.
  shoal::occupancy_grid_t map = test::flat_map({-10, -10}, {10, 10}, 0.1);
  test::set_box(map, {-0.5, -10}, {0.5, -2});
  test::set_box(map, {-0.5, 2}, {0.5, 7});
  test::set_box(map, {-1, -2}, {1, 2}, -1);
  const PlanGrid grid = grid_of(map);
  PathCosts costs;
  // 8 m with 2 m of unknown ground, or about 17 m.
  EXPECT_LT(length_m(search_path(grid, {-4, 0}, {4, 0}, costs)), 8.1);
  costs.unknown_cost = 6;
  EXPECT_GT(length_m(search_path(grid, {-4, 0}, {4, 0}, costs)), 15);
  costs.unknown_cost = 0;
  costs.enters_unknown = false;
  EXPECT_GT(length_m(search_path(grid, {-4, 0}, {4, 0}, costs)), 15);
}

TEST(PathSearch, LeavesAPlaceThatIsTooNearToAnObstacle) {
  const PlanGrid grid = grid_of(one_box());
  // 0.3 m beside the box.
  const Path path = search_path(grid, {0, 1.3}, {6, 1.3}, {});
  ASSERT_FALSE(path.points_W.empty()) << path.why_none;
  EXPECT_GE(clearance_m(grid, path), 0.2);
  EXPECT_LT(length_m(path), 7);
}

TEST(PathSearch, SaysWhyThereIsNoPath) {
  shoal::occupancy_grid_t map = one_box();
  test::set_box(map, {5, -10}, {5.3, 10});
  const PlanGrid grid = grid_of(map);
  const auto why = [&](const Vector2d& to_W, const PathCosts& costs) {
    const Path path = search_path(grid, {-7, 0}, to_W, costs);
    EXPECT_TRUE(path.points_W.empty());
    return path.why_none;
  };
  EXPECT_EQ(why({7, 0}, {}), "no gap on the path is 1.20 m wide");
  EXPECT_EQ(why({11, 0}, {}), "the goal is outside of the map");
  EXPECT_THAT(why({4.72, 0}, {}), HasSubstr("the goal is 0.30 m from an obstacle, and must be 0.60 m"));
  EXPECT_EQ(search_path(grid, {-11, 0}, {0, 5}, {}).why_none, "it is outside of the map");
}

TEST(GridFrame, RefusesMapsThatAreNone) {
  const auto reason = [](auto change) {
    shoal::occupancy_grid_t map = test::flat_map({0, 0}, {1, 1}, 0.1);
    change(map);
    try {
      autonomy::frame_of(map);
    } catch (const shoal::MessageError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(reason([](auto&) {}), "");
  EXPECT_THAT(reason([](auto& map) { map.width = -10; }), HasSubstr("got 100 of -10 x 10"));
  EXPECT_THAT(reason([](auto& map) { map.width = 0; }), HasSubstr("got 100 of 0 x 10"));
  EXPECT_THAT(reason([](auto& map) { map.cell_m = 0; }), HasSubstr("'cell_m' must be from 0.001 to 1 m, got 0"));
  EXPECT_THAT(reason([](auto& map) { map.origin_m[1] = 1e9; }), HasSubstr("'origin_m' must be within 1e+07 m"));
}

TEST(PathSearch, DoesNotStepOverAWallOfOneCell) {
  shoal::occupancy_grid_t map = test::flat_map({-5, -5}, {5, 5}, 0.1);
  test::set_box(map, {0, -5}, {0.1, 5});
  PathCosts costs;
  costs.keep_m = 0.05;  // less than a cell
  const Path path = autonomy::search_path(grid_of(map), {-3, 0}, {3, 0.5}, costs);
  EXPECT_TRUE(path.points_W.empty());
  EXPECT_THAT(path.why_none, HasSubstr("no gap on the path"));
}

}  // namespace
