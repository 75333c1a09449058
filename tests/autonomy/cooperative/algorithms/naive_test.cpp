// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "autonomy/cooperative/filter/own_filter.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace {

using namespace navigation;

using test::far_m;
using test::nav_setup;
using test::received_from;
using test::started;

TEST(Naive, AddsTheVarianceOfTheSenderToThatOfTheRange) {
  const auto own = started("naive", nav_setup(2, 0, {0, 0}, 2));
  const auto sender = started("naive", nav_setup(2, 1, {-far_m, 0}, 3));
  own->on_range(received_from(1, sender->make_payload(0, 100), far_m + 14));
  // S = 4 + 9 + 1 = 14: it moves by 4 / 14 of the innovation of 14 m.
  const Estimate estimate = own->now(0);
  EXPECT_NEAR(estimate.p_W.x(), 4, 1e-4);
  EXPECT_NEAR(estimate.P(0, 0), 4 - 16.0 / 14, 1e-4);
  EXPECT_NEAR(estimate.P(1, 1), 4, 1e-6);
}

TEST(Naive, CountsItsOwnInformationAgain) {
  const auto own = started("naive", nav_setup(2, 0, {0, 0}, 2));
  const auto other = started("naive", nav_setup(2, 1, {-far_m, 0}, 3));
  for (int i = 0; i < 20; ++i) {
    own->on_range(received_from(1, other->make_payload(0, 100), far_m));
    other->on_range(received_from(0, own->make_payload(0, 100), far_m));
  }
  // Together they know x_0 - x_1 to 1 m / sqrt(40), and the mean of both to 1 / (1 / 4 + 1 / 9): x_0 to 1.66 m.
  EXPECT_LT(std::sqrt(own->now(0).P(0, 0)), 0.8);
}

}  // namespace
