// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/missions/marine/report_clock.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using autonomy::ReportClock;

constexpr std::int64_t second = 1'000'000;
constexpr double period_s = 0.5;

/// A clock after a report at 100 s, and the decisions of some time since.
ReportClock clock_after(double silent_s) {
  ReportClock clock(period_s);
  EXPECT_EQ(clock.note(100 * second).set_us, 0);
  for (double t_s = period_s; t_s <= silent_s; t_s += period_s) clock.step();
  return clock;
}

TEST(ReportClock, StampsThatAreALittleLateOrEarlyAreNoJump) {
  for (const double later_s : {-2.0, -0.3, 0.0, 0.2, 5.0}) {
    ReportClock clock = clock_after(0);
    const auto jump = clock.note(100 * second + std::llround(1e6 * later_s));
    EXPECT_EQ(jump.set_us, 0) << later_s;
    EXPECT_EQ(jump.silent_s, 0) << later_s;
    EXPECT_EQ(clock.time(), 100 * second + std::llround(1e6 * std::max(later_s, 0.0))) << later_s;
  }
}

TEST(ReportClock, AJumpInWhichNoTimePassedIsAClockThatWasSet) {
  for (const std::int64_t set_us : {-3600 * second, -3 * second, 6 * second, 3600 * second}) {
    ReportClock clock = clock_after(0);
    const auto jump = clock.note(100 * second + set_us);
    EXPECT_EQ(jump.set_us, set_us);
    EXPECT_EQ(jump.silent_s, 0);
    EXPECT_EQ(clock.time(), 100 * second + set_us);
  }
}

TEST(ReportClock, TimeThatAlsoPassedForTheProgramIsSilence) {
  ReportClock clock = clock_after(8);
  EXPECT_TRUE(clock.is_silent());
  const auto jump = clock.note(108 * second);
  EXPECT_EQ(jump.set_us, 0);
  EXPECT_NEAR(jump.silent_s, 8, 1e-9);
  EXPECT_FALSE(clock.is_silent());
}

TEST(ReportClock, ThatIsSetInASilenceIsBoth) {
  ReportClock clock = clock_after(8);
  const auto jump = clock.note(1108 * second);
  EXPECT_EQ(jump.set_us, 1000 * second);
  EXPECT_NEAR(jump.silent_s, 8, 1e-9);
}

TEST(ReportClock, OfAProgramThatSeldomDecidesIsNotSetByEachReport) {
  // Of the decisions of 5 s that the clock counts, nearly all may be before the last report.
  ReportClock clock(5);
  std::int64_t utime = 100 * second;
  for (int i = 0; i < 100; ++i) {
    if (i % 50 == 0) clock.step();
    EXPECT_EQ(clock.note(utime).set_us, 0) << i;
    utime += second / 10;
  }
}

TEST(ReportClock, IsSilentAfterAPeriodAndASecondWithoutAReport) {
  EXPECT_FALSE(clock_after(1.5).is_silent());  // 1 s at least
  EXPECT_TRUE(clock_after(2).is_silent());
}

}  // namespace
