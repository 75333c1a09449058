// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "autonomy/filters/marine_ekf.hpp"
#include "tests/autonomy/second.hpp"

// What the filter makes of measurements that do not fit, for long.

namespace {

using autonomy::MarineEkf;
using autonomy::Vector2d;
using Outcome = MarineEkf::Outcome;

using test::second;

MarineEkf::Range range_between(const Vector2d& p_W, double range_m, std::int64_t utime) {
  MarineEkf::Range range;
  range.utime = utime;
  range.range_m = range_m;
  range.p_WS.head<2>() = p_W;
  return range;
}

TEST(MarineEkfContradiction, FixesThatContradictAreRefusedUntilThereAreTooMany) {
  MarineEkf ekf(0, {100, 0}, 1, {});
  for (int i = 1; i < 5; ++i) {
    EXPECT_EQ(ekf.update_position(0, {150, 0}, 1), Outcome::refused);
    EXPECT_DOUBLE_EQ(ekf.position().x(), 100);
  }
  EXPECT_EQ(ekf.update_position(0, {150, 0}, 1), Outcome::inflated);
  EXPECT_NEAR(ekf.position().x(), 150, 0.1);  // 50 m x 1 m^2 / (50 m)^2
  EXPECT_EQ(ekf.inflated(), 1);
}

MarineEkf::Range range_of(int beacon, double range_m) {
  // East and north of an AUV at (100, 50).
  MarineEkf::Range range = range_between(beacon == 1 ? Vector2d(0, 50) : Vector2d(100, 0), range_m, 0);
  range.beacon = beacon;
  return range;
}

MarineEkf with_a_clock() {
  MarineEkf::Params params;
  params.states = 6;
  return {0, {100, 50}, 1, params};
}

TEST(MarineEkfContradiction, BeaconThatContradictsMovesNothingHoweverOften) {
  for (const int states : {2, 4, 5, 6}) {
    MarineEkf::Params params;
    params.states = states;
    MarineEkf ekf(0, {100, 50}, 1, params);
    const MarineEkf before = ekf;
    for (int i = 0; i < 50; ++i) EXPECT_EQ(ekf.update_range(range_of(1, 100 + 200)), Outcome::refused);
    EXPECT_EQ(ekf.state(), before.state());
    EXPECT_EQ(ekf.covariance(), before.covariance());
  }
}

TEST(MarineEkfContradiction, ABadBeaconDoesNotKeepAGoodOneOut) {
  MarineEkf ekf = with_a_clock();
  for (int i = 0; i < 30; ++i) {
    EXPECT_EQ(ekf.update_range(range_of(1, 100 + 200)), Outcome::refused);
    EXPECT_EQ(ekf.update_range(range_of(2, 50)), Outcome::accepted);
  }
  EXPECT_NEAR((ekf.position() - Vector2d(100, 50)).norm(), 0, 1e-9);
  EXPECT_NEAR(ekf.range_bias_m(), 0, 1e-9);
  EXPECT_EQ(ekf.inflated(), 0);
}

TEST(MarineEkfContradiction, WhatAllBeaconsSayAlikeIsTheClock) {
  for (const double error_m : {750.0, -1500.0}) {  // clocks that are 0.5 s ahead and 1 s behind
    MarineEkf ekf = with_a_clock();
    for (const int beacon : {1, 2, 1, 2})
      EXPECT_EQ(ekf.update_range(range_of(beacon, (beacon == 1 ? 100 : 50) + error_m)), Outcome::refused);
    EXPECT_EQ(ekf.update_range(range_of(1, 100 + error_m)), Outcome::inflated);
    EXPECT_EQ(ekf.update_range(range_of(2, 50 + error_m)), Outcome::accepted);
    EXPECT_NEAR(ekf.range_bias_m(), error_m, 3);
    EXPECT_NEAR((ekf.position() - Vector2d(100, 50)).norm(), 0, 0.1);
    // It localizes itself as before, or better by the two ranges.
    EXPECT_LT(ekf.position_covariance()(0, 0), 1.01);
    EXPECT_LT(ekf.position_covariance()(1, 1), 1.01);
  }
}

TEST(MarineEkfContradiction, OneBeaconAloneOrTwoThatDisagreeAreNoReasonToDoubtTheClock) {
  MarineEkf alone = with_a_clock();
  MarineEkf disagreeing = with_a_clock();
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(alone.update_range(range_of(1, 100 + 750)), Outcome::refused);
    EXPECT_EQ(disagreeing.update_range(range_of(i % 2 + 1, 750 + (i % 2 == 0 ? 100 + 200 : 50))), Outcome::refused);
  }
  EXPECT_EQ(alone.state(), with_a_clock().state());
  EXPECT_EQ(disagreeing.covariance(), with_a_clock().covariance());
}

TEST(MarineEkfContradiction, BeaconInDoubtIsBelievedAfterFiveThatFit) {
  MarineEkf ekf = with_a_clock();
  for (int i = 0; i < 5; ++i) ekf.update_range(range_of(1, 100 + 200));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(ekf.update_range(range_of(1, 100)), Outcome::refused);
  EXPECT_EQ(ekf.update_range(range_of(1, 100)), Outcome::accepted);
}

TEST(MarineEkfContradiction, BeaconInDoubtIsNotBelievedBecauseTheFilterGrewUnsure) {
  MarineEkf ekf(0, {100, 0}, 1, {});
  const auto wrong = [&](std::int64_t t) { return range_between({0, 0}, ekf.position_at(t).norm() + 40, t); };
  for (int i = 0; i < 5; ++i) ekf.update_range(wrong(0));
  for (int i = 1; i <= 2000; ++i) ekf.predict(i * second, {1, 1});
  EXPECT_GT(std::sqrt(ekf.position_covariance().trace()), 40);  // the gate alone would let it through
  for (int i = 0; i < 20; ++i) EXPECT_EQ(ekf.update_range(wrong(2000 * second)), Outcome::refused);
}

TEST(MarineEkfContradiction, AnErrorOfTheClockThatGrowsEvenlyIsItsDrift) {
  MarineEkf ekf = with_a_clock();
  const auto late_by_m = [](int t) { return 750 + 0.15 * t; };  // 0.5 s ahead and 100 ppm fast
  const auto receive_state = [&](int t) {
    ekf.predict(t * second, {0, 0});
    const int beacon = t / 10 % 2 + 1;
    MarineEkf::Range range = range_of(beacon, (beacon == 1 ? 100 : 50) + late_by_m(t));
    range.utime = t * second;
    return ekf.update_range(range);
  };
  for (const int t : {0, 10, 20, 30}) EXPECT_EQ(receive_state(t), Outcome::refused) << t;
  EXPECT_EQ(receive_state(40), Outcome::inflated);
  for (int t = 50; t <= 300; t += 10) EXPECT_EQ(receive_state(t), Outcome::accepted) << t;
  EXPECT_NEAR(ekf.range_bias_m(), late_by_m(300), 2);
  EXPECT_NEAR(ekf.state()[5], 0.15, 0.02);
  EXPECT_LT((ekf.position() - Vector2d(100, 50)).norm(), 1);
}

TEST(MarineEkfContradiction, WhatWrongRangesTaughtIsForgotten) {
  MarineEkf ekf = with_a_clock();
  const MarineEkf reckoned = ekf;
  for (int i = 0; i < 20; ++i)  // near enough to be believed
    for (const int beacon : {1, 2}) ekf.update_range(range_of(beacon, beacon == 1 ? 102 : 48));
  EXPECT_GT((ekf.position() - reckoned.position()).norm(), 0.5);
  int refused = 0;
  while (refused < 20 &&
         ekf.update_range(range_of(refused % 2 + 1, refused % 2 == 0 ? 150 : 20), &reckoned) == Outcome::refused)
    ++refused;
  EXPECT_EQ(refused, 9);  // with the tenth it starts again
  EXPECT_EQ(ekf.position(), reckoned.position());
  EXPECT_EQ(ekf.position_covariance(), reckoned.position_covariance());
  EXPECT_GT(ekf.covariance()(4, 4), 30 * 30);
  // Nothing that ranges taught is left: it does not start again again.
  for (int i = 0; i < 30; ++i)
    EXPECT_EQ(ekf.update_range(range_of(i % 2 + 1, i % 2 == 0 ? 3000 : -5000), &reckoned), Outcome::refused) << i;
  EXPECT_EQ(ekf.inflated(), 1);
}

TEST(MarineEkfContradiction, ClockThatWasSetClearsTheBeaconsOfDoubt) {
  MarineEkf ekf = with_a_clock();
  for (int i = 0; i < 5; ++i) EXPECT_EQ(ekf.update_range(range_of(1, 100 + 200)), Outcome::refused);
  ekf.shift_clock(second, 1500, 30);
  MarineEkf::Range range = range_of(1, 100 + 1500);
  range.utime = second;
  EXPECT_EQ(ekf.update_range(range), Outcome::accepted);
}

}  // namespace
