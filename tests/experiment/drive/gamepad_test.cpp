// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/gamepad.hpp"

#include <gmock/gmock.h>
#include <linux/input.h>

#include "experiment/drive/drive_profile.hpp"
#include "experiment/drive/input_events.hpp"

namespace {

class GamepadTest : public testing::Test {
 protected:
  experiment::Gamepad pad{experiment::read_drive_profile("").gamepad};
};

TEST_F(GamepadTest, IsHeldWhileTheDeadManButtonIsDown) {
  EXPECT_FALSE(pad.holds());
  pad.take({0, EV_KEY, BTN_TL, 1});
  EXPECT_TRUE(pad.holds());
  pad.take({0, EV_KEY, BTN_TL, 2});
  EXPECT_TRUE(pad.holds());
  pad.take({0, EV_KEY, BTN_TL, 0});
  EXPECT_FALSE(pad.holds());
}

TEST_F(GamepadTest, IsReleasedWhenTheKernelDroppedEvents) {
  pad.take({0, EV_KEY, BTN_TL, 1});
  pad.take({0, EV_SYN, SYN_DROPPED, 0});
  EXPECT_FALSE(pad.holds());
  pad.take({0, EV_KEY, BTN_TL, 2});
  EXPECT_FALSE(pad.holds());
}

TEST_F(GamepadTest, HasADeadBandAndFullDeflectionAtTheEndsOfTheRange) {
  pad.set_range(ABS_Y, 0, 255);
  const auto forward = [&](int value) {
    pad.take({0, EV_ABS, ABS_Y, value});
    return pad.values().at("forward");
  };
  EXPECT_DOUBLE_EQ(forward(0), 1);  // up is negative
  EXPECT_DOUBLE_EQ(forward(255), -1);
  EXPECT_DOUBLE_EQ(forward(128), 0);
  // Half way up: deflection 1 - 2 * 64 / 255, of which 0.1 is the dead band.
  EXPECT_NEAR(forward(64), (1 - 2 * 64 / 255. - 0.1) / 0.9, 1e-12);
  pad.take({0, EV_ABS, ABS_Y, 1000});
  EXPECT_DOUBLE_EQ(pad.values().at("forward"), -1);
}

}  // namespace
