// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/imu_t.hpp"
#include "tests/bridges/ros2/converted.hpp"

namespace {

using test::converted;
using test::expect_header;

TEST(RosConventions, AnImuWithoutOrientationSaysSo) {
  auto in = converted(shoal::imu_t{1'500'000, {1, 2, 3}, {4, 5, 6}}, "imu");
  expect_header(*in, "auv1/x");
  for (const double value : {0.0, 0.0, 0.0, 1.0, -1.0}) EXPECT_EQ(in->number<double>(), value);
}

}  // namespace
