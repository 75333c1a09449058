// SPDX-License-Identifier: BSD-3-Clause
#include "sim/geometry/box_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace {

using sim::AlignedBox;
using sim::BoxGrid;
using sim::Vector3d;

std::vector<int> found(const BoxGrid& grid, const AlignedBox& query) {
  std::vector<int> numbers;
  grid.find(query, [&](int index) { numbers.push_back(index); });
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

TEST(BoxGrid, EmptyFindsNothing) {
  BoxGrid grid;
  grid.build({});
  EXPECT_TRUE(found(grid, {Vector3d(-1, -1, -1), Vector3d(1, 1, 1)}).empty());
}

TEST(BoxGrid, BoxesInOnePlaceAreAllFound) {
  BoxGrid grid;
  const std::vector<AlignedBox> boxes(5, {Vector3d(1, 1, 1), Vector3d(1, 1, 1)});
  grid.build(boxes);
  EXPECT_EQ(found(grid, {Vector3d(0, 0, 0), Vector3d(1, 1, 1)}).size(), 5u);
  EXPECT_EQ(found(grid, {Vector3d(0, 0, 0), Vector3d(0.9, 1, 1)}).size(), 0u);
}

TEST(BoxGrid, FindsWhatALoopOverAllBoxesFinds) {
  std::mt19937 random(1);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  const auto box = [&](double spread, double size) {
    const Vector3d low(uniform(-spread, spread), uniform(-spread, spread), uniform(-spread, spread));
    return AlignedBox{low, low + Vector3d(uniform(0, size), uniform(0, size), uniform(0, size))};
  };
  for (int round = 0; round < 20; ++round) {
    std::vector<AlignedBox> boxes;
    for (int i = 0; i < 300; ++i) boxes.push_back(box(50, i % 20 == 0 ? 60 : 3));
    if (round % 2) boxes.push_back({Vector3d(1e6, 1e6, 0), Vector3d(1e6 + 1, 1e6 + 1, 1)});  // a lost one
    BoxGrid grid;
    grid.build(boxes);
    for (int k = 0; k < 50; ++k) {
      const AlignedBox query = box(60, 30);
      std::vector<int> expected;
      for (int i = 0; i < static_cast<int>(boxes.size()); ++i)
        if (boxes[i].meets(query)) expected.push_back(i);
      EXPECT_EQ(found(grid, query), expected);
    }
  }
}

}  // namespace
