// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/estimate_t.hpp"
#include "tests/bridges/ros2/converted.hpp"

namespace {

using namespace bridges::ros2;

using test::converted;
using test::expect_header;

TEST(Ros2Converter, AnEstimateIsAPoseInTheWorldWithItsCovariance) {
  shoal::estimate_t estimate{1'500'000, {1, 2, 3}, {1, 2, 3, 4, 5, 6, 7, 8, 9}, {0, 0, 0}, M_PI, 0};
  auto in = converted(estimate, "pose");
  expect_header(*in, "world");
  for (const double value : {1.0, 2.0, 3.0, 0.0, 0.0, 1.0}) EXPECT_EQ(in->number<double>(), value);
  EXPECT_NEAR(in->number<double>(), 0.0, 1e-15);  // cos(pi/2)
  const double rows[3][6] = {{1, 2, 3, 0, 0, 0}, {4, 5, 6, 0, 0, 0}, {7, 8, 9, 0, 0, 0}};
  for (const auto& row : rows)
    for (const double value : row) EXPECT_EQ(in->number<double>(), value);
  in->skip<double>(18);
  EXPECT_TRUE(in->at_end());
}

}  // namespace
