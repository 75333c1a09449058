// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <cmath>

#include "shoal/gps_data_t.hpp"
#include "tests/bridges/ros2/converted.hpp"

namespace {

using namespace bridges::ros2;

using test::converted;
using test::expect_header;

TEST(Ros2Converter, AFixHasVariancesOfItsAccuracy) {
  shoal::gps_data_t gps{};
  gps.utime = 1'500'000;
  gps.gps_lock = 2;
  gps.latitude = 47;
  gps.longitude = 8;
  gps.elev = 400;
  gps.horizontal_accuracy = 3;
  gps.vertical_accuracy = 5;
  auto in = converted(gps, "fix", "auv1.gps");
  expect_header(*in, "auv1/gps");
  EXPECT_EQ(in->number<std::int8_t>(), 2);  // ground-based augmentation
  EXPECT_EQ(in->number<std::uint16_t>(), 1);
  for (const double value : {47.0, 8.0, 400.0, 9.0, 0.0, 0.0, 0.0, 9.0, 0.0, 0.0, 0.0, 25.0})
    EXPECT_EQ(in->number<double>(), value);
  EXPECT_EQ(in->number<std::uint8_t>(), 2);  // the diagonal is known
  EXPECT_TRUE(in->at_end());
}

TEST(RosConventions, TheCourseIsFromNorthAndTheVelocityHasEastFirst) {
  shoal::gps_data_t gps{};
  gps.utime = 1'500'000;
  EXPECT_FALSE(converted(gps, "velocity", "auv1.gps"));  // no fix
  gps.gps_lock = 1;
  gps.speed = 2;
  gps.heading = M_PI / 6;  // 30 degrees from north towards east
  auto in = converted(gps, "velocity", "auv1.gps");
  expect_header(*in, "world");
  EXPECT_NEAR(in->number<double>(), 1, 1e-12);
  EXPECT_NEAR(in->number<double>(), std::sqrt(3), 1e-12);
  for (int i = 0; i < 4 + 36; ++i) EXPECT_EQ(in->number<double>(), 0);
  EXPECT_TRUE(in->at_end());
}

TEST(RosConventions, WithoutAFixTheCovarianceIsUnknown) {
  shoal::gps_data_t gps{};
  gps.utime = 1'500'000;
  gps.latitude = gps.horizontal_accuracy = gps.vertical_accuracy = NAN;
  auto in = converted(gps, "fix", "auv1.gps");
  expect_header(*in, "auv1/gps");
  EXPECT_EQ(in->number<std::int8_t>(), -1);
  in->skip<std::uint16_t>(1);
  EXPECT_TRUE(std::isnan(in->number<double>()));
  in->skip<double>(2);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(in->number<double>(), 0);
  EXPECT_EQ(in->number<std::uint8_t>(), 0);
}

}  // namespace
