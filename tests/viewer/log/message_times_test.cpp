// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log/message_times.hpp"

#include <gtest/gtest.h>

#include "shoal/message_codec.hpp"
#include "shoal/utime_t.hpp"
#include "sim/bus/bus.hpp"

namespace {

sim::Bytes stamped(std::int64_t utime) {
  return shoal::encode(shoal::utime_t{utime});
}

TEST(MessageTimes, TheStampIsBehindTheFingerprint) {
  EXPECT_EQ(viewer::stamp_of(stamped(123)), 123);
  EXPECT_EQ(viewer::stamp_of(stamped(-1)), -1);
  sim::Bytes cut = stamped(123);
  cut.pop_back();
  EXPECT_FALSE(viewer::stamp_of(cut));
}

TEST(MessageTimes, InARecordOfShoalTheStampsAreTheTime) {
  viewer::MessageTimes times;
  times.take("sim.clock", stamped(1000), 1000);
  times.take("rover.lidar", stamped(7), 1500);
  EXPECT_EQ(times.interpolated_us(), 1500);
  EXPECT_EQ(times.steady_us(), 1500);
}

TEST(MessageTimes, StampsOfAnotherClockAreMovedByWhatTheSimulatorSays) {
  viewer::MessageTimes times(50);
  times.take("rover.lidar", stamped(7), 90'000);
  EXPECT_EQ(times.steady_us(), 50);  // nothing is known yet
  times.take("sim.state", stamped(1000), 100'000);
  times.take("rover.lidar", stamped(7), 100'400);
  EXPECT_EQ(times.interpolated_us(), 1400);
  EXPECT_EQ(times.steady_us(), 1000);
  times.take("sim.bodies", stamped(1300), 100'500);  // the run is slower than that clock
  EXPECT_EQ(times.interpolated_us(), 1300);
}

TEST(MessageTimes, ADamagedMessageOfTheSimulatorIsOneLikeOthers) {
  viewer::MessageTimes times;
  times.take("sim.clock", stamped(1000), 101'000);
  sim::Bytes cut = stamped(9);
  cut.resize(10);
  times.take("sim.clock", cut, 102'000);
  EXPECT_EQ(times.interpolated_us(), 2000);
}

}  // namespace
