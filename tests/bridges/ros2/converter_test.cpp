// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/ros2/converter.hpp"

#include <gmock/gmock.h>

namespace {

using namespace bridges::ros2;

TEST(Ros2Converter, TheTopicIsBelowTheChannelOrCommon) {
  EXPECT_EQ((Converter{"", "", "scan", {}}.topic_for("rover1.lidar")), "/rover1/lidar/scan");
  EXPECT_EQ((Converter{"", "", "/tf", {}}.topic_for("sim.state")), "/tf");
}

}  // namespace
