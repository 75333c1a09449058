// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/drive_keys.hpp"

#include <gtest/gtest.h>

#include "experiment/drive/driver.hpp"

namespace {

using namespace std::chrono_literals;

TEST(DriveKeys, StepsStopAtFullDeflectionAndComeBackToZero) {
  experiment::DriveKeys keys(experiment::read_drive_profile("").keys);
  for (int i = 0; i < 9; ++i) keys.press("w");
  EXPECT_EQ(keys.values().at("forward"), 1);
  for (int i = 0; i < 4; ++i) keys.press("s");
  EXPECT_EQ(keys.values().at("forward"), 0);
  keys.press("a");
  EXPECT_EQ(keys.press("x"), experiment::DriveKeys::Effect::none);
  EXPECT_TRUE(keys.values().empty());
}

}  // namespace
