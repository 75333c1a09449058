// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>

#include "shoal/battery_t.hpp"
#include "tests/bridges/ros2/converted.hpp"

namespace {

using namespace bridges::ros2;

using test::converted;
using test::expect_header;

TEST(Ros2Converter, ADischargingBatteryHasANegativeCurrent) {
  auto in = converted(shoal::battery_t{1'500'000, 12, 2, 0.5, 0, 0}, "battery");
  expect_header(*in, "auv1/x");
  EXPECT_EQ(in->number<float>(), 12.0f);
  EXPECT_TRUE(std::isnan(in->number<float>()));
  EXPECT_EQ(in->number<float>(), -2.0f);
}

}  // namespace
