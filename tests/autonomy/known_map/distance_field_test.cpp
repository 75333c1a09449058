// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/known_map/distance_field.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "autonomy/known_map/path_search.hpp"
#include "tests/autonomy/known_map/flat_map.hpp"

namespace {

TEST(DistanceField, IsTheDistanceToTheNearestMarkedCell) {
  const autonomy::GridFrame frame{{1, 2}, 0.5, 37, 23};
  std::vector<char> marked(frame.size());
  const std::vector<std::pair<int, int>> places = {{3, 4}, {30, 20}, {31, 2}, {12, 11}};
  for (const auto& [column, row] : places) marked[frame.index(column, row)] = 1;
  const std::vector<float> distances = distances_m(frame, marked);
  for (int row = 0; row < frame.rows; ++row)
    for (int column = 0; column < frame.columns; ++column) {
      double nearest_m = 1e9;
      for (const auto& [c, r] : places) nearest_m = std::min(nearest_m, 0.5 * std::hypot(c - column, r - row));
      EXPECT_FLOAT_EQ(distances[frame.index(column, row)], static_cast<float>(nearest_m)) << column << ' ' << row;
    }
  EXPECT_TRUE(std::isinf(distances_m(frame, std::vector<char>(frame.size())).front()));
}

}  // namespace
