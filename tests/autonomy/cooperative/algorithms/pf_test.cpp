// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "autonomy/cooperative/filter/own_filter.hpp"
#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace {

using namespace navigation;

using test::far_m;
using test::nav_second;
using test::nav_setup;
using test::received_from;
using test::started;

TEST(ParticleStart, FindsAnUnknownStartByTheRangesOfThreeSenders) {
  navigation::Setup setup = nav_setup(4, 0, {0, 0}, 1000);
  const auto filter = started("pf", setup);
  const Vector2 truth(400, -250);
  const Vector2 senders[] = {{0, 0}, {500, 0}, {0, 500}};
  for (int i = 0; i < 12; ++i) {
    const Time now = 10 * (i + 1) * nav_second;
    filter->predict(now, {0, 0}, 1e-3 * Matrix2::Identity());
    const Vector2 sender = senders[i % 3];
    const auto other = started("naive", nav_setup(4, 1 + i % 3, sender, 0.5));
    filter->on_range(received_from(1 + i % 3, other->make_payload(0, 100), (truth - sender).norm(), 1, now));
  }
  EXPECT_NEAR((filter->now(120 * nav_second).p_W - truth).norm(), 0, 3);
  EXPECT_LT(filter->now(120 * nav_second).P.trace(), 9);
}

TEST(ParticleStart, IsNaiveAfterAKnownStart) {
  const auto filter = started("pf", nav_setup(2, 0, {0, 0}, 2));
  const auto sender = started("naive", nav_setup(2, 1, {-far_m, 0}, 3));
  filter->on_range(received_from(1, sender->make_payload(0, 100), far_m + 14));
  EXPECT_NEAR(filter->now(0).p_W.x(), 4, 1e-4);
}

}  // namespace
