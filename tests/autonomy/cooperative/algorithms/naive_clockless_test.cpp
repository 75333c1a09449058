// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "autonomy/cooperative/filter/own_filter.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace {

using namespace navigation;

using test::far_m;
using test::nav_setup;
using test::received_from;
using test::started;

TEST(NaiveWithoutClocks, TakesTheErrorOfItsClockForOneOfItsPosition) {
  navigation::Setup setup = nav_setup(2, 0, {0, 0}, 2);
  setup.team[0].errors.clock_s = 0.002;  // 3 m
  const auto with_clock = started("naive", setup), without = started("naive_clockless", setup);
  const auto sender = started("naive", nav_setup(2, 1, {-far_m, 0}, 3));
  for (const auto& own : {with_clock.get(), without.get()})
    own->on_range(received_from(1, sender->make_payload(0, 100), far_m + 7));
  EXPECT_NEAR(with_clock->now(0).p_W.x(), 7 * 4.0 / (4 + 9 + 9 + 1), 1e-3);
  EXPECT_NEAR(without->now(0).p_W.x(), 7 * 4.0 / (4 + 9 + 1), 1e-3);
  EXPECT_EQ(without->now(0).clock_error_s, 0);
}

}  // namespace
