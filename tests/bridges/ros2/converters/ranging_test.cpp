// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "shoal/planar_lidar_t.hpp"
#include "shoal/sonar_range_t.hpp"
#include "tests/bridges/ros2/converted.hpp"
#include "tests/bridges/ros2/known_devices.hpp"

namespace {

using namespace known_devices;
using bridges::ros2::ConverterContext;

using namespace bridges::ros2;

using test::converted;
using test::expect_header;

TEST(Ros2Converter, TheLastBeamOfAScanIsAtItsLargestAngle) {
  auto in = converted(shoal::planar_lidar_t{1'500'000, 3, {1, 2, 3}, 0, {}, -1.0f, 0.5f}, "scan");
  expect_header(*in, "auv1/x");
  for (const float value : {-1.0f, 0.0f, 0.5f, 0.0f, 0.0f, 0.0f}) EXPECT_EQ(in->number<float>(), value);
  EXPECT_EQ(in->number<float>(), std::numeric_limits<float>::infinity());
  EXPECT_EQ(in->number<std::uint32_t>(), 3u);
  for (const float value : {1.0f, 2.0f, 3.0f}) EXPECT_EQ(in->number<float>(), value);
  EXPECT_EQ(in->number<std::uint32_t>(), 0u);
  EXPECT_TRUE(in->at_end());
}

constexpr float infinite = std::numeric_limits<float>::infinity();

TEST(RosConventions, AMissIsInfiniteAndWhatIsTooNearIsMinusInfinite) {
  ConverterContext context = knowing(device_with(R"({"kind": "fan", "range_m": 10, "range_min_m": 0.2})"));
  const shoal::planar_lidar_t scan{1'500'000, 4, {10, 9.99f, 0.2f, 0.21f}, 0, {}, -1, 0.5f};
  for (const char* channel : {"auv1.x", "auv1.x.truth"}) {
    auto in = converted(scan, "scan", channel, &context);
    expect_header(*in, "auv1/x");
    in->skip<float>(5);
    EXPECT_EQ(in->number<float>(), 0.2f);
    EXPECT_EQ(in->number<float>(), 10);
    ASSERT_EQ(in->number<std::uint32_t>(), 4u);
    for (const float range_m : {infinite, 9.99f, -infinite, 0.21f}) EXPECT_EQ(in->number<float>(), range_m);
  }
}

TEST(RosConventions, AScannerWithoutALeastRangeHasNothingThatIsTooNear) {
  ConverterContext context = knowing(device_with(R"({"kind": "fan", "range_m": 10, "range_min_m": 0})"));
  auto in = converted(shoal::planar_lidar_t{1'500'000, 2, {0, NAN}, 0, {}, -1, 0.5f}, "scan", "auv1.x", &context);
  expect_header(*in, "auv1/x");
  in->skip<float>(7);
  in->skip<std::uint32_t>(1);
  EXPECT_EQ(in->number<float>(), 0);
  EXPECT_TRUE(std::isnan(in->number<float>()));  // erroneous
}

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
