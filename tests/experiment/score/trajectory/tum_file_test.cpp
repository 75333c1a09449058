// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/score/trajectory/tum_file.hpp"

#include <gtest/gtest.h>

#include "experiment/score/trajectory/estimate_file.hpp"
#include "sim/config/diagnostics.hpp"

namespace {

using experiment::EstimateFile;
using experiment::parse_estimates;

TEST(EstimateFile, ReadsTum) {
  const EstimateFile file = parse_estimates("# t x y z qx qy qz qw\n0.5 1 -2 3e0 0 0 0 1\n\n1.5\t4 5 6 0 0 1 0\n", "f");
  ASSERT_EQ(file.rows.size(), 2u);
  EXPECT_EQ(file.rows[0].time_s, 0.5);
  EXPECT_EQ(file.rows[0].position_m, sim::Vector3d(1, -2, 3));
  EXPECT_EQ(file.rows[1].position_m, sim::Vector3d(4, 5, 6));
  EXPECT_TRUE(file.has_height);
  EXPECT_FALSE(file.rows[0].covariance_m2);
}

}  // namespace
