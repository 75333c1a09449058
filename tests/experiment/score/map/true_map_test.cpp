// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/map/true_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "sim/world/world_editor.hpp"
#include "tests/devices/world_fixture.hpp"

namespace {

using experiment::Cell;
using experiment::GridMap;
using experiment::MapFrame;

std::string map_world(const std::string& objects) {
  return test::rover_world("", objects, "    position_m: [100, 100, 0]\n");
}

/// Counts of the cells in each state.
std::map<Cell, int> counts_of(const GridMap& map) {
  std::map<Cell, int> counts;
  for (const Cell cell : map.cells) ++counts[cell];
  return counts;
}

// 40 x 40 cells of 0.1 m around (0, 0).
const MapFrame frame = experiment::frame_of_area({-2, -2, 2, 2}, 0.1);

TEST(TrueMap, HasTheOutlineOfABoxAndItsInsideIsSolid) {
  // From -0.55 to 0.55: 0.05 m, half a cell, inside of the cells 14 and 25, which its outline crosses.
  const test::TestWorld test(map_world(
      "  - {name: crate, fixed: true, position_m: [0, 0, 0.5], parts: [{shape: box, size_m: [1.11, 1.11, 1]}]}\n"));
  const GridMap map = experiment::true_map(test.world, frame, 0.3);
  const auto counts = counts_of(map);
  // A ring of 12 x 12 cells, of which the inner 10 x 10 are solid.
  EXPECT_EQ(counts.at(Cell::occupied), 12 * 12 - 10 * 10);
  EXPECT_EQ(counts.at(Cell::solid), 10 * 10);
  EXPECT_EQ(counts.at(Cell::free), 40 * 40 - 12 * 12);
  EXPECT_EQ(map.cells[frame.index(14, 14)], Cell::occupied);
  EXPECT_EQ(map.cells[frame.index(13, 20)], Cell::free);
  EXPECT_EQ(map.cells[frame.index(20, 20)], Cell::solid);
}

TEST(TrueMap, SurfacesOnTheBorderOfTwoCellsBelongToTheInside) {
  const test::TestWorld test(
      map_world("  - {name: crate, fixed: true, position_m: [0, 0, 0.5], parts: [{shape: box, size_m: [1, 1, 1]}]}\n"));
  const GridMap map = experiment::true_map(test.world, frame, 0.3);
  EXPECT_EQ(counts_of(map).at(Cell::occupied), 10 * 10 - 8 * 8);
  EXPECT_EQ(map.cells[frame.index(15, 20)], Cell::occupied);
  EXPECT_EQ(map.cells[frame.index(14, 20)], Cell::free);
}

TEST(TrueMap, IsOfOneHeightAndHasNoVehicles) {
  const test::TestWorld test(test::rover_world(
      "", "  - {name: shelf, fixed: true, position_m: [0, 0, 1], parts: [{shape: box, size_m: [1, 1, 1]}]}\n",
      "    position_m: [1, 1, 0]\n"));
  EXPECT_EQ(counts_of(experiment::true_map(test.world, frame, 0.3)).at(Cell::free), 40 * 40);
  EXPECT_GT(counts_of(experiment::true_map(test.world, frame, 0.7)).at(Cell::occupied), 0);
}

TEST(TrueMap, OutlineOfACircleHasTheLengthOfItsRows) {
  const test::TestWorld test(map_world(
      "  - {name: post, fixed: true, position_m: [0.013, 0.021, 0.5], parts: [{shape: cylinder, radius_m: 1.5, "
      "length_m: 1}]}\n"));
  const GridMap map = experiment::true_map(test.world, frame, 0.3);
  // Every occupied cell is within half a diagonal of a cell of the circle, and all together cover its area.
  int covered = 0;
  for (int row = 0; row < frame.height; ++row)
    for (int column = 0; column < frame.width; ++column) {
      const Cell cell = map.cells[frame.index(column, row)];
      const double r = std::hypot(-2 + 0.1 * (column + 0.5) - 0.013, -2 + 0.1 * (row + 0.5) - 0.021);
      if (cell == Cell::occupied) {
        EXPECT_NEAR(r, 1.5, 0.5 * std::numbers::sqrt2 * 0.1);
      }
      if (cell == Cell::solid) {
        EXPECT_LT(r, 1.5);
      }
      covered += cell != Cell::free ? 1 : 0;
    }
  // The circle and at most half of the cells of its outline, 2 pi r / cell, more.
  const double area = std::numbers::pi * 1.5 * 1.5 / 0.01;
  EXPECT_NEAR(covered, area + 47, 47);
}

TEST(TrueMap, ObjectsThatTouchLeaveNoTrace) {
  const test::TestWorld test(map_world(
      "  - {name: left, fixed: true, position_m: [-0.5, 0, 0.5], parts: [{shape: box, size_m: [1, 1, 1]}]}\n"
      "  - {name: right, fixed: true, position_m: [0.5, 0, 0.5], parts: [{shape: box, size_m: [1, 1, 1]}]}\n"));
  const GridMap map = experiment::true_map(test.world, frame, 0.3);
  for (int column : {0, 5, 35, 39}) EXPECT_EQ(map.cells[frame.index(column, 20)], Cell::free) << column;
}

TEST(TrueMap, FollowsTheWorld) {
  test::TestWorld test(
      map_world("  - {name: crate, fixed: true, position_m: [0, 0, 0.5], parts: [{shape: box, size_m: [1, 1, 1]}]}\n"));
  test.world.editor().remove_object("crate");
  test.world.step();
  EXPECT_EQ(counts_of(experiment::true_map(test.world, frame, 0.3)).at(Cell::free), 40 * 40);
}

TEST(TrueMap, AreaIsThatOfTheObjectsAtItsHeight) {
  const test::TestWorld test(
      map_world("  - {name: crate, fixed: true, position_m: [3, -2, 0.5], parts: [{shape: box, size_m: [1, 1, 1]}]}\n"
                "  - {name: lamp, fixed: true, position_m: [30, 0, 5], parts: [{shape: box, size_m: [1, 1, 1]}]}\n"));
  const auto area = experiment::area_of_objects(test.world, 0.3);
  ASSERT_TRUE(area);
  // 2.5 to 3.5 and -2.5 to -1.5, a meter more, in whole meters.
  EXPECT_EQ(area->x_min_m, 1);
  EXPECT_EQ(area->x_max_m, 5);
  EXPECT_EQ(area->y_min_m, -4);
  EXPECT_EQ(area->y_max_m, 0);
  EXPECT_FALSE(experiment::area_of_objects(test.world, 20));
}

TEST(TrueMap, RefusesEmptyAndHugeAreas) {
  EXPECT_THROW(experiment::frame_of_area({1, 0, 1, 2}, 0.1), std::invalid_argument);
  EXPECT_THROW(experiment::frame_of_area({0, 0, 1e5, 1e5}, 0.1), std::invalid_argument);
}

}  // namespace
