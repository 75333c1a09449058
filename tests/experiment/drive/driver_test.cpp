// SPDX-License-Identifier: BSD-3-Clause
#include "experiment/drive/driver.hpp"

#include <gtest/gtest.h>

#include "shoal/message_codec.hpp"
#include "shoal/twist_command_t.hpp"

namespace {

using namespace std::chrono_literals;

using Clock = experiment::Driver::Clock;

class DriverTest : public testing::Test {
 protected:
  /// Returns the commanded speed at a time after the start; none: nothing is commanded.
  std::optional<double> speed_at(Clock::duration at) {
    const auto commands = driver.due(start + at, 0, {});
    if (commands.empty()) return std::nullopt;
    return shoal::decode<shoal::twist_command_t>(commands.front().payload, shoal::Finite::required).forward_mps;
  }
  const Clock::time_point start{1h};
  experiment::DriveProfile profile = experiment::read_drive_profile("");
  experiment::Driver driver{profile, {"v", {{"drive", "skid_steer", "v.drive.cmd", "shoal.twist_command_t"}}}, {}};
};

TEST_F(DriverTest, CommandsNothingBeforeTheFirstSignOfLife) {
  EXPECT_EQ(speed_at(0s), std::nullopt);
}

TEST_F(DriverTest, CommandsAtItsRateWhileItIsHeld) {
  int commands = 0;
  for (int ms = 0; ms < 1000; ms += 5) {
    driver.hold({{"forward", 1}}, start + ms * 1ms);
    if (const auto speed = speed_at(ms * 1ms)) {
      EXPECT_EQ(*speed, 1);
      ++commands;
    }
  }
  EXPECT_EQ(commands, 20);
}

TEST_F(DriverTest, StopsAFifthOfASecondAfterTheLastSignOfLife) {
  driver.hold({{"forward", 1}}, start);
  EXPECT_EQ(speed_at(0ms), 1);
  EXPECT_EQ(speed_at(100ms), 1);
  EXPECT_EQ(speed_at(199ms), 1);
  EXPECT_EQ(speed_at(200ms), 0);
  // Repeated, because a datagram may be lost, and then nothing more.
  EXPECT_EQ(speed_at(249ms), std::nullopt);
  EXPECT_EQ(speed_at(250ms), 0);
  EXPECT_EQ(speed_at(300ms), 0);
  EXPECT_FALSE(driver.busy());
  EXPECT_EQ(speed_at(350ms), std::nullopt);
}

TEST_F(DriverTest, StopsAtOnceWhenItIsReleased) {
  driver.hold({{"forward", 1}}, start);
  EXPECT_EQ(speed_at(0ms), 1);
  driver.release();
  EXPECT_EQ(speed_at(1ms), 0);
}

TEST_F(DriverTest, CommandsAChangeAtOnce) {
  driver.hold({{"forward", 1}}, start);
  EXPECT_EQ(speed_at(0ms), 1);
  driver.hold({{"forward", 0.5}}, start + 10ms);
  EXPECT_EQ(speed_at(10ms), 0.5);
}

TEST_F(DriverTest, ATappedKeyMovesForAFifthOfASecondOnly) {
  experiment::DriveKeys keys(profile.keys);
  ASSERT_EQ(keys.press("up"), experiment::DriveKeys::Effect::sign_of_life);
  driver.hold(keys.values(), start);
  EXPECT_EQ(speed_at(0ms), 0.25);
  EXPECT_EQ(speed_at(200ms), 0);
  // A terminal repeats a held key after half a second, then 30 times a second.
  for (int ms = 500; ms < 1000; ms += 33) {
    ASSERT_EQ(keys.press("space"), experiment::DriveKeys::Effect::sign_of_life);
    driver.hold(keys.values(), start + ms * 1ms);
    EXPECT_NE(speed_at(ms * 1ms), 0) << ms;
  }
  EXPECT_EQ(speed_at(1200ms), 0);
}

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
