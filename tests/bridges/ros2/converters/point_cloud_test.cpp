// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converters/point_cloud.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "shoal/multibeam_t.hpp"
#include "shoal/point_cloud_t.hpp"
#include "tests/bridges/ros2/converted.hpp"

namespace {

using namespace bridges::ros2;

using test::converted;
using test::expect_header;

TEST(Ros2Converter, PointsHaveTheirColumns) {
  auto in = converted(shoal::point_cloud_t{1'500'000, 1, {1}, {2}, {3}, {0.5f}, {7}, {-20}}, "points");
  expect_header(*in, "auv1/x");
  EXPECT_EQ(in->number<std::uint32_t>(), 1u);
  EXPECT_EQ(in->number<std::uint32_t>(), 1u);
  ASSERT_EQ(in->number<std::uint32_t>(), 6u);
  std::uint32_t end = 0;
  for (const char* name : {"x", "y", "z", "intensity", "time_us", "ring"}) {
    EXPECT_EQ(in->text(), name);
    EXPECT_EQ(in->number<std::uint32_t>(), end);
    const int datatype = in->number<std::uint8_t>();
    end += datatype == 4 ? 2 : 4;
    EXPECT_EQ(in->number<std::uint32_t>(), 1u);
  }
  EXPECT_EQ(in->number<std::uint8_t>(), 0);
  EXPECT_EQ(in->number<std::uint32_t>(), end);
  EXPECT_EQ(in->number<std::uint32_t>(), end);
  ASSERT_EQ(in->number<std::uint32_t>(), 22u);
  in->skip<std::uint8_t>(22);
  EXPECT_EQ(in->number<std::uint8_t>(), 1);
  EXPECT_TRUE(in->at_end());
}

TEST(Ros2Converter, OnlyBeamsWithAnEchoArePoints) {
  shoal::multibeam_t ping{1'500'000, 2, {0.0f, 0.5f}, {10.0f, 20.0f}, {60.0f, 70.0f}, {0, 1}};
  auto in = converted(ping, "points");
  expect_header(*in, "auv1/x");
  in->number<std::uint32_t>();
  EXPECT_EQ(in->number<std::uint32_t>(), 1u);  // width
  ASSERT_EQ(in->number<std::uint32_t>(), 4u);
  for (int i = 0; i < 4; ++i) {
    in->text();
    in->number<std::uint32_t>();
    in->number<std::uint8_t>();
    in->number<std::uint32_t>();
  }
  in->skip<std::uint8_t>(1);
  in->skip<std::uint32_t>(2);
  ASSERT_EQ(in->number<std::uint32_t>(), 16u);
  EXPECT_EQ(in->number<float>(), 0.0f);
  EXPECT_FLOAT_EQ(in->number<float>(), 20.0f * std::sin(0.5f));   // to port
  EXPECT_FLOAT_EQ(in->number<float>(), -20.0f * std::cos(0.5f));  // down
  EXPECT_EQ(in->number<float>(), 70.0f);
}

}  // namespace
