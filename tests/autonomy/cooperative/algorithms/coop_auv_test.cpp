// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "autonomy/cooperative/filter/own_filter.hpp"
#include "autonomy/filters/chi_square.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace {

using namespace navigation;

using test::far_m;
using test::nav_second;
using test::nav_setup;
using test::received_from;
using test::started;

TEST(CoopAuvFilter, AddsTheVarianceOfTheSenderToThatOfTheRange) {
  const auto own = started("coop_auv", nav_setup(2, 0, {0, 0}, 2));
  const auto sender = started("naive", nav_setup(2, 1, {-far_m, 0}, 3));
  own->on_range(received_from(1, sender->make_payload(0, 100), far_m + 14));
  const Estimate estimate = own->now(0);  // S = 4 + 9 + 1
  EXPECT_NEAR(estimate.p_W.x(), 4, 1e-3);
  EXPECT_NEAR(estimate.P(0, 0), 4 - 16.0 / 14, 1e-3);
}

TEST(CoopAuvFilter, DoubtsASenderThatContradictsAndStillUsesTheOther) {
  navigation::Setup setup = nav_setup(3, 0, {0, 0}, 2);
  setup.gate = autonomy::chi_square_999_1;
  const auto own = started("coop_auv", setup);
  const auto west = started("naive", nav_setup(3, 1, {-far_m, 0}, 1)),
             south = started("naive", nav_setup(3, 2, {0, -far_m}, 1));
  Time now = 0;
  const auto receive = [&](int sender, const Bytes& payload, double range_m) {
    now += nav_second;
    own->predict(now, {0, 0}, 1e-6 * Matrix2::Identity());
    own->on_range(received_from(sender, payload, range_m, 1, now));
  };
  for (int i = 0; i < 6; ++i) receive(1, west->make_payload(0, 100), far_m + 500);
  receive(1, west->make_payload(0, 100), far_m + 1);  // agrees, but it is in doubt
  EXPECT_NEAR(own->now(now).p_W.x(), 0, 1e-9);
  receive(2, south->make_payload(0, 100), far_m + 6);
  EXPECT_NEAR(own->now(now).p_W.y(), 6 * 4.0 / (4 + 1 + 1), 1e-3);
}

}  // namespace
