// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/vector_field_histogram.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "autonomy/behaviors/avoid_behavior.hpp"
#include "autonomy/behaviors/make_behavior.hpp"
#include "autonomy/behaviors/velocity_obstacles.hpp"
#include "tests/autonomy/behaviors/avoiding_craft.hpp"

namespace {

using namespace avoiding_craft;

using autonomy::VectorFieldHistogram;

TEST(VectorFieldHistogram, BlocksTheSectorsOfAnEnlargedObstacle) {
  const VectorFieldHistogram law(params);
  // 20 m ahead: asin((1 + 4) / 20) = 14.5 degrees to both sides, 2 sectors of 5 degrees.
  const auto blocked = law.blocked(eastwards(), 1.5, 30, {{{{20, 0}, {0, 0}, 1}}});
  for (int i = -3; i <= 3; ++i) EXPECT_EQ(blocked[static_cast<std::size_t>((i + 72) % 72)], std::abs(i) <= 2) << i;
}

TEST(VectorFieldHistogram, BlocksWhatItsTurnDoesNotReach) {
  // At 1.5 m/s and 0.3 rad/s it turns on circles of 5 m: a pile 6 m abeam to port is in the way of a turn to port.
  const VectorFieldHistogram law(params);
  const auto blocked = law.blocked(eastwards(), 1.5, 30, {{{{2, 6}, {0, 0}, 1}}});
  EXPECT_FALSE(blocked[0]);
  EXPECT_TRUE(blocked[24]);   // 120 degrees to port, behind the pile
  EXPECT_FALSE(blocked[54]);  // 90 degrees to starboard
}

}  // namespace
