// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <limits>

#include "shoal/sim_event_t.hpp"
#include "shoal/utime_t.hpp"
#include "tests/bridges/ros2/converted.hpp"

namespace {

using namespace bridges::ros2;

using test::converted;

TEST(Ros2Converter, AFaultIsAWarningInTheLog) {
  auto in = converted(shoal::sim_event_t{1'500'000, 0, "fault", "a/lidar", "stuck"}, "/rosout", "sim.event");
  EXPECT_EQ(in->number<std::int32_t>(), 1);
  EXPECT_EQ(in->number<std::uint32_t>(), 500'000'000u);
  EXPECT_EQ(in->number<std::uint8_t>(), 30);
  EXPECT_EQ(in->text(), "a/lidar");
  EXPECT_EQ(in->text(), "fault: stuck");
}

using namespace bridges::ros2;

using test::converted;

TEST(Ros2Converter, TimeBeforeTheEpochHasPositiveNanoseconds) {
  auto in = converted(shoal::utime_t{-1}, "/clock", "sim.clock");
  EXPECT_EQ(in->number<std::int32_t>(), -1);
  EXPECT_EQ(in->number<std::uint32_t>(), 999'999'000u);
}

TEST(Ros2Converter, TimesBeyondTheRangeOfRosAreItsEnds) {
  // 2040-01-01: seconds are 32-bit numbers.
  auto in = converted(shoal::utime_t{2'208'988'800'000'000}, "/clock", "sim.clock");
  EXPECT_EQ(in->number<std::int32_t>(), std::numeric_limits<std::int32_t>::max());
  EXPECT_EQ(in->number<std::uint32_t>(), 0u);
  in = converted(shoal::utime_t{std::numeric_limits<std::int64_t>::min()}, "/clock", "sim.clock");
  EXPECT_EQ(in->number<std::int32_t>(), std::numeric_limits<std::int32_t>::min());
}

TEST(Ros2Converter, OnlyTheClockOfTheSimulatorIsTheClock) {
  EXPECT_TRUE(converted(shoal::utime_t{5}, "/clock", "sim.clock"));
  EXPECT_FALSE(converted(shoal::utime_t{5}, "/clock", "auv1.beat"));
}

}  // namespace
