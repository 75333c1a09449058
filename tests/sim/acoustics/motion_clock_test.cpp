// SPDX-License-Identifier: BSD-3-Clause
#include "sim/acoustics/motion_clock.hpp"

#include <gtest/gtest.h>

namespace {

TEST(MotionClock, MotionIsTheSameForAllEventsOfAStep) {
  sim::MotionClock clock;
  EXPECT_LT(clock.serial(), 0) << "bodies may move before the events";
  clock.begin(sim::Time{1000});
  const std::int64_t first = clock.serial();
  EXPECT_GE(first, 0);
  clock.end();
  EXPECT_LT(clock.serial(), 0);
  clock.begin(sim::Time{1000});
  EXPECT_EQ(clock.serial(), first);
  clock.end();
  clock.begin(sim::Time{2000});
  EXPECT_NE(clock.serial(), first);
  EXPECT_EQ(clock.step_end(), sim::Time{2000});
}

TEST(MotionClock, MotionIsAnotherAfterARestore) {
  sim::MotionClock clock;
  clock.begin(sim::Time{1000});
  const std::int64_t before = clock.serial();
  sim::StateArchive saver = sim::StateArchive::saver();
  saver(clock);
  const std::vector<std::byte> bytes = saver.take_bytes();
  sim::StateArchive restorer = sim::StateArchive::restorer(bytes);
  restorer(clock);
  EXPECT_EQ(clock.step_end(), sim::Time{1000});
  clock.begin(sim::Time{1000});
  EXPECT_NE(clock.serial(), before);
}

}  // namespace
