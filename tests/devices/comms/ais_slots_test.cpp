// SPDX-License-Identifier: BSD-3-Clause
#include "devices/comms/ais_slots.hpp"

#include <gtest/gtest.h>

#include <set>

namespace {

using namespace devices;

constexpr double knot = 1852.0 / 3600;

double interval_s(AisStation station, double knots, bool moored = false, bool turning = false) {
  return static_cast<double>(ais_interval_slots(station, knots * knot, moored, turning)) * 60 / ais_slots_per_minute;
}

TEST(AisSlots, AMinuteHas2250WithoutGaps) {
  EXPECT_EQ(ais_slot_begin_us(2250), 60'000'000);
  EXPECT_EQ(ais_slot_begin_us(1), 26'667);  // 26666.67, rounded up
  for (const std::int64_t slot : {0LL, 1LL, 2LL, 3LL, 66'000'000'001LL}) {
    EXPECT_EQ(ais_slot_from(ais_slot_begin_us(slot)), slot);
    EXPECT_EQ(ais_slot_from(ais_slot_begin_us(slot) + 1), slot + 1);
  }
}

TEST(AisSlots, IntervalsAreThoseOfTheTablesOfTheRecommendation) {
  EXPECT_EQ(interval_s(AisStation::class_a, 0, true), 180);
  EXPECT_EQ(interval_s(AisStation::class_a, 4, true), 10);
  EXPECT_EQ(interval_s(AisStation::class_a, 14), 10);
  EXPECT_NEAR(interval_s(AisStation::class_a, 14, false, true), 10.0 / 3, 0.02);
  EXPECT_EQ(interval_s(AisStation::class_a, 15), 6);
  EXPECT_EQ(interval_s(AisStation::class_a, 15, false, true), 2);
  EXPECT_EQ(interval_s(AisStation::class_a, 24), 2);
  EXPECT_EQ(interval_s(AisStation::class_b, 1.9), 180);
  EXPECT_EQ(interval_s(AisStation::class_b, 2.1), 30);
}

TEST(AisSlots, AreAnyWithinATenthOfTheInterval) {
  std::set<std::int64_t> chosen;
  for (int i = 0; i < 1000; ++i) {
    sim::Random random(1, "test");
    random.begin_step(i);
    chosen.insert(choose_ais_slot(10'000, 75, 1, {}, random));
  }
  // 7 to each side: 15 slots, each of which a thousand draws miss with a probability of 1e-30.
  EXPECT_EQ(chosen.size(), 15u);
  EXPECT_EQ(*chosen.begin(), 9'993);
  EXPECT_EQ(*chosen.rbegin(), 10'007);
}

TEST(AisSlots, ThoseThatOthersHaveReservedAreAvoided) {
  AisReservations reserved;
  for (std::int64_t slot = 9'993; slot <= 10'007; ++slot)
    if (slot % 3 != 0) reserved.reserve(slot);  // 9993, 9996, ... 10005 remain: five
  for (int i = 0; i < 100; ++i) {
    sim::Random random(1, "test");
    random.begin_step(i);
    EXPECT_EQ(choose_ais_slot(10'000, 75, 1, reserved, random) % 3, 0);
  }
  // No two in a row are free: too few, so that any is taken.
  sim::Random random(1, "test");
  random.begin_step(0);
  const std::int64_t any = choose_ais_slot(10'000, 75, 2, reserved, random);
  EXPECT_GE(any, 9'993);
  EXPECT_LE(any, 10'007);
  reserved.forget_before(10'000);
  EXPECT_FALSE(reserved.has(9'997));
  EXPECT_TRUE(reserved.has(10'000));
}

}  // namespace
