// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/behaviors/wander.hpp"

#include <gtest/gtest.h>

#include <set>

namespace {

using autonomy::Scan;
using autonomy::Twist;
using autonomy::Wander;

/// 180 beams of 8 m; `range_m` at one of them.
Scan scan_with(float range_m, std::size_t beam) {
  Scan scan;
  scan.ranges_m.assign(180, 8.0F);
  scan.ranges_m[beam] = range_m;
  return scan;
}

const Scan free_scan = scan_with(8, 0);
const Scan blocked_scan = scan_with(0.99F, 90);

TEST(Wander, DrivesAheadWhereNothingIs) {
  Wander wander(1, "rover1");
  for (int i = 0; i < 100; ++i) {
    const Twist twist = wander.step(free_scan);
    EXPECT_DOUBLE_EQ(twist.forward_mps, 0.4);
    EXPECT_DOUBLE_EQ(twist.turn_radps, 0);
  }
}

TEST(Wander, LooksAtTheMiddleThird) {
  for (const std::size_t beam : {60u, 90u, 119u})
    EXPECT_DOUBLE_EQ(Wander(1, "rover1").step(scan_with(0.99F, beam)).turn_radps, 0.5) << beam;
  for (const std::size_t beam : {0u, 59u, 120u, 179u})
    EXPECT_DOUBLE_EQ(Wander(1, "rover1").step(scan_with(0.99F, beam)).turn_radps, 0) << beam;
  EXPECT_DOUBLE_EQ(Wander(1, "rover1").step(scan_with(1.01F, 90)).turn_radps, 0);
}

TEST(Wander, TurnsForTenToNineteenSteps) {
  Wander wander(1, "rover1");
  std::set<int> lengths;
  for (int turn = 0; turn < 200; ++turn) {
    int steps = 0;
    Twist twist = wander.step(blocked_scan);
    while (twist.turn_radps > 0) {
      EXPECT_DOUBLE_EQ(twist.forward_mps, 0.05);
      ++steps;
      twist = wander.step(free_scan);
    }
    EXPECT_GE(steps, 10);
    EXPECT_LE(steps, 19);
    lengths.insert(steps);
  }
  // Each of ten lengths is missed by 200 draws with probability 0.9^200 = 7e-10.
  EXPECT_EQ(lengths.size(), 10u);
}

TEST(Wander, StopsBeforeWhatIsClose) {
  Wander wander(1, "rover1");
  for (const std::size_t beam : {0u, 90u, 179u}) {
    const Twist twist = wander.step(scan_with(0.29F, beam));
    EXPECT_DOUBLE_EQ(twist.forward_mps, 0);
    EXPECT_DOUBLE_EQ(twist.turn_radps, 0.5);  // or it would stand there forever
  }
}

TEST(Wander, GoesTheSameWayEveryTime) {
  const auto turns = [](const char* name) {
    Wander wander(7, name);
    std::vector<bool> turning;
    for (int i = 0; i < 500; ++i) turning.push_back(wander.step(i % 40 == 0 ? blocked_scan : free_scan).turn_radps > 0);
    return turning;
  };
  EXPECT_EQ(turns("rover1"), turns("rover1"));
  EXPECT_NE(turns("rover1"), turns("rover2"));
}

}  // namespace
