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

TEST(NaiveOfDeadReckoning, SaysWhatItKnowsWithoutRanges) {
  const auto own = started("naive_dr", nav_setup(2, 0, {0, 0}, 2));
  const Bytes before = own->make_payload(0, 100);
  const auto sender = started("naive_dr", nav_setup(2, 1, {-far_m, 0}, 0.1));
  own->on_range(received_from(1, sender->make_payload(0, 100), far_m + 10));
  EXPECT_LT(own->now(0).P(0, 0), 1);
  EXPECT_EQ(own->make_payload(0, 100), before);
}

}  // namespace
