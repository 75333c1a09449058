// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/sim_event_t.hpp"
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

}  // namespace
