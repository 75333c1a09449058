// SPDX-License-Identifier: BSD-3-Clause
#include "autonomy/filters/range_aided_ekf.hpp"

#include <gtest/gtest.h>

#include "tests/autonomy/second.hpp"

namespace {

using autonomy::MarineEkf;
using autonomy::RangeAidedEkf;
using autonomy::Vector2d;
using test::second;

/// An AUV at (100, 50) with a clock, beacon 1 west and beacon 2 south of it.
RangeAidedEkf with_a_clock() {
  MarineEkf::Params params;
  params.states = 6;
  return {0, {100, 50}, 1, params};
}

MarineEkf::Range range_of(int beacon, double range_m, std::int64_t utime = 0) {
  MarineEkf::Range range;
  range.beacon = beacon;
  range.utime = utime;
  range.range_m = range_m;
  range.p_WS.head<2>() = beacon == 1 ? Vector2d(0, 50) : Vector2d(100, 0);
  return range;
}

TEST(RangeAidedEkf, OnlyRangesDistinguishItFromItsDeadReckoning) {
  RangeAidedEkf ekf = with_a_clock();
  MarineEkf alone = ekf.with_ranges();
  ekf.predict(second, {1, 0.5}, 0.3);
  alone.predict(second, {1, 0.5}, 0.3);
  ekf.update_position(second, {101, 51}, 2);
  alone.update_position(second, {101, 51}, 2);
  ekf.shift_clock(10 * second, 15'000, 30);
  alone.shift_clock(10 * second, 15'000, 30);
  EXPECT_EQ(ekf.with_ranges().state(), alone.state());
  EXPECT_EQ(ekf.with_ranges().utime(), 11 * second);
  EXPECT_TRUE(ekf.update_range(range_of(1, 15'103, 11 * second)));
  EXPECT_NE(ekf.with_ranges().state(), alone.state());
  EXPECT_EQ(ekf.without_ranges().state(), alone.state());
  EXPECT_EQ(ekf.without_ranges().covariance(), alone.covariance());
  EXPECT_EQ(ekf.without_ranges().utime(), 11 * second);
}

TEST(RangeAidedEkf, RestartsFromItsDeadReckoningWhenNoRangeFits) {
  RangeAidedEkf ekf = with_a_clock();
  for (int i = 0; i < 20; ++i)  // near enough to be believed
    for (const int beacon : {1, 2}) EXPECT_TRUE(ekf.update_range(range_of(beacon, beacon == 1 ? 102 : 48)));
  EXPECT_GT((ekf.with_ranges().position() - Vector2d(100, 50)).norm(), 0.5);
  // Errors of the two that differ: the tenth says that earlier ranges were wrong.
  for (int i = 0; i < 9; ++i) EXPECT_FALSE(ekf.update_range(range_of(i % 2 + 1, i % 2 == 0 ? 150 : 20))) << i;
  EXPECT_TRUE(ekf.update_range(range_of(2, 20)));
  EXPECT_EQ(ekf.with_ranges().position(), ekf.without_ranges().position());
  EXPECT_EQ(ekf.with_ranges().position_covariance(), ekf.without_ranges().position_covariance());
}

}  // namespace
