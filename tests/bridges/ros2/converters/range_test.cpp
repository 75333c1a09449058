// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <limits>

#include "shoal/sonar_range_t.hpp"
#include "tests/bridges/ros2/converted.hpp"
#include "tests/bridges/ros2/known_devices.hpp"

namespace {

using namespace known_devices;
using bridges::ros2::ConverterContext;

using namespace bridges::ros2;

using test::converted;
using test::expect_header;

TEST(Ros2Converter, ASonarWithoutAnEchoReportsAnInfiniteRange) {
  auto in = converted(shoal::sonar_range_t{1'500'000, 50, 0, 0}, "range");
  expect_header(*in, "auv1/x");
  in->skip<std::uint8_t>(1);
  in->skip<float>(3);
  EXPECT_EQ(in->number<float>(), std::numeric_limits<float>::infinity());
}

TEST(RosConventions, ARangeHasTheLimitsOfItsSonarAndIsAlongXOfItsFrame) {
  // An altimeter looks down.
  ConverterContext context =
      knowing(device_with(R"({"kind": "cone", "axis": [0, 0, -1], "half_angle_rad": 0.1, "range_m": 50,
                              "range_min_m": 0.5})"));
  auto in = converted(shoal::sonar_range_t{1'500'000, 7, 90, 1}, "range", "auv1.x", &context);
  expect_header(*in, "auv1/x_beam");
  EXPECT_EQ(in->number<std::uint8_t>(), 0);  // ultrasound
  for (const float value : {0.2f, 0.5f, 50.0f, 7.0f}) EXPECT_FLOAT_EQ(in->number<float>(), value);
  in->skip<float>(1);
  EXPECT_TRUE(in->at_end());
}

}  // namespace
