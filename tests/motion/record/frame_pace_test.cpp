// SPDX-License-Identifier: BSD-3-Clause
#include "motion/record/frame_pace.hpp"

#include <gtest/gtest.h>

namespace {

using std::chrono::milliseconds;

TEST(FramePace, CountsFramesThatAreLateByMoreThanAStep) {
  motion::FramePace pace(milliseconds(8), milliseconds(2));
  const motion::FramePace::Clock::time_point start{};
  pace.restart(start);
  for (const int at_ms : {8, 18, 27, 32}) pace.begin(start + milliseconds(at_ms));  // due at 8, 16, 24 and 32
  EXPECT_EQ(pace.text(), "1 of 4 frames began more than a step, 2 ms, late, by 3.0 ms at most");
  EXPECT_EQ(pace.due(), start + milliseconds(40));  // it has caught up
}

TEST(FramePace, AfterALongDelayTheRecordingIsSlowerThanTheClock) {
  motion::FramePace pace(milliseconds(8), milliseconds(2));
  const motion::FramePace::Clock::time_point start{};
  pace.restart(start);
  pace.begin(start + milliseconds(8 + 101));
  EXPECT_EQ(pace.due(), start + milliseconds(8 + 101 + 8));
  pace.begin(pace.due());
  EXPECT_EQ(pace.late(), 1);
  // A pause is not a delay.
  pace.restart(start + milliseconds(5000));
  pace.begin(start + milliseconds(5008));
  EXPECT_EQ(pace.late(), 1);
  EXPECT_EQ(pace.frames(), 3);
}

}  // namespace
