// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "shoal/dvl_t.hpp"
#include "tests/bridges/ros2/converted.hpp"

namespace {

using namespace bridges::ros2;

using test::converted;

TEST(Ros2Converter, ADvlWithoutBottomLockGivesNoVelocity) {
  shoal::dvl_t dvl{};
  EXPECT_FALSE(converted(dvl, "velocity"));
  dvl.bottom_lock = 1;
  EXPECT_TRUE(converted(dvl, "velocity"));
}

}  // namespace
