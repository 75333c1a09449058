// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "autonomy/cooperative/filter/own_filter.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace {

using namespace navigation;

using test::nav_second;
using test::nav_setup;
using test::received_from;
using test::started;

TEST(DeadReckoning, HearsNothingAndSaysNothing) {
  const auto dr = started("dr", nav_setup(2, 0, {0, 0}, 1));
  dr->predict(100 * nav_second, {1, 2}, 0.01 * Matrix2::Identity());
  const auto other = started("naive", nav_setup(2, 1, {500, 0}, 1));
  dr->on_range(received_from(1, other->make_payload(0, 100), 450));
  EXPECT_TRUE(dr->make_payload(100 * nav_second, 100).empty());
  const Estimate estimate = dr->now(101 * nav_second);
  EXPECT_TRUE(estimate.p_W.isApprox(Vector2(101, 202)));
  EXPECT_TRUE(estimate.P.isApprox(2 * Matrix2::Identity()));  // 1 + 0.01 * 100
}

}  // namespace
