// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/campaign/tune.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace {

using testing::ElementsAre;

/// Points with these values, none of which has been judged.
std::vector<experiment::TunedPoint> points_with(const std::vector<double>& values) {
  std::vector<experiment::TunedPoint> points;
  for (const double value : values) points.push_back({1, points.size(), value, 2});
  return points;
}

TEST(Tune, APointWithoutAValueIsBelowAllOthers) {
  const double none = std::nan("");
  EXPECT_THAT(experiment::ranked_values(points_with({3, none, 5}), false), ElementsAre(-3, -10, -5));
  EXPECT_THAT(experiment::ranked_values(points_with({3, none, 5}), true), ElementsAre(3, 0, 5));
  EXPECT_THAT(experiment::ranked_values(points_with({none, none}), true), ElementsAre(-1, -1));
}

TEST(Tune, APointThatBreaksTheRulesIsBelowThoseThatDoNot) {
  std::vector<experiment::TunedPoint> points = points_with({3, 9, 8, 4, std::nan("")});
  points[1].failed = 1;
  points[2].failed = 1;
  points[3].failed = 2;
  // The best of each group is below the worst of the one before by its size, at least by 1.
  EXPECT_THAT(experiment::ranked_values(points, true), ElementsAre(3, 0, -1, -2, -4));
}

}  // namespace
