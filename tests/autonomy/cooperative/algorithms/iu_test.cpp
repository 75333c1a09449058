// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace {

using namespace navigation;
using test::far_m;
using test::nav_setup;
using test::received_from;
using test::started;

/// Sets of the filters in a payload.
std::vector<int> sets_in(const Bytes& payload) {
  std::vector<int> sets;
  for (std::size_t i = 0; i < payload.size(); i += 13) sets.push_back(payload[i]);
  return sets;
}

TEST(InterleavedUpdate, ARangeMakesAFilterOfBothVehicles) {
  const auto a = started("iu", nav_setup(3, 0, {0, 0}, 2));
  const auto b = started("iu", nav_setup(3, 1, {-far_m, 0}, 3));
  EXPECT_EQ(sets_in(b->make_payload(0, 100)), std::vector<int>{0b010});
  a->on_range(received_from(1, b->make_payload(0, 100), far_m + 14));
  EXPECT_EQ(sets_in(a->make_payload(0, 100)), (std::vector<int>{0b011, 0b001}));  // the best first
  EXPECT_NEAR(a->now(0).P(0, 0), 4 - 16.0 / 14, 1e-3);
}

TEST(InterleavedUpdate, InformationThatComesBackIsNotUsed) {
  const auto a = started("iu", nav_setup(3, 0, {0, 0}, 2));
  const auto b = started("iu", nav_setup(3, 1, {-far_m, 0}, 3));
  for (int i = 0; i < 20; ++i) {
    a->on_range(received_from(1, b->make_payload(0, 100), far_m));
    b->on_range(received_from(0, a->make_payload(0, 100), far_m));
  }
  // One range of 1 m between the two: 4 - 16 / 14, however often it is repeated.
  EXPECT_NEAR(a->now(0).P(0, 0), 4 - 16.0 / 14, 0.01);
}

TEST(InterleavedUpdate, AThirdVehicleAddsToTheSet) {
  const auto a = started("iu", nav_setup(3, 0, {0, 0}, 2));
  const auto b = started("iu", nav_setup(3, 1, {-far_m, 0}, 3));
  const auto c = started("iu", nav_setup(3, 2, {far_m, 0}, 3));
  b->on_range(received_from(2, c->make_payload(0, 100), 2 * far_m));
  a->on_range(received_from(1, b->make_payload(0, 100), far_m));
  const std::vector<int> sets = sets_in(a->make_payload(0, 100));
  EXPECT_EQ(sets.size(), 3U);
  EXPECT_EQ(sets.front(), 0b111);
  // It already has c: a range to it updates only the filters without c, so that {a, c} is added.
  a->on_range(received_from(2, c->make_payload(0, 100), far_m));
  EXPECT_EQ(sets_in(a->make_payload(0, 100)).size(), 4U);
}

TEST(InterleavedUpdate, SatellitesAreNewsEachTime) {
  const auto a = started("iu", nav_setup(2, 0, {0, 0}, 2));
  const auto craft = started("iu", nav_setup(2, 1, {-far_m, 0}, 1e4));
  for (int i = 1; i <= 2; ++i) {
    // The deviation of 10 km before the fix leaves nothing of what it said.
    craft->predict(i * test::nav_second, {0, 0}, 1e8 * Matrix2::Identity());
    craft->fix(i * test::nav_second, {-far_m, 0}, 3);
    a->on_range(received_from(1, craft->make_payload(i * test::nav_second, 100), far_m));
  }
  // Two ranges of variance 10: 1 / (1 / 4 + 2 / 10).
  EXPECT_NEAR(a->now(0).P(0, 0), 1 / 0.45, 1e-3);
  EXPECT_EQ(sets_in(a->make_payload(0, 100)), std::vector<int>{0b01});
  // Without another fix it is no news.
  EXPECT_EQ(sets_in(craft->make_payload(2 * test::nav_second, 100)), std::vector<int>{0b10});
}

TEST(InterleavedUpdate, SaysTheBestFiltersThatFit) {
  const auto a = started("iu", nav_setup(3, 0, {0, 0}, 2));
  const auto b = started("iu", nav_setup(3, 1, {-far_m, 0}, 3));
  a->on_range(received_from(1, b->make_payload(0, 100), far_m));
  EXPECT_EQ(sets_in(a->make_payload(0, 25)), std::vector<int>{0b011});
}

TEST(InterleavedUpdate, ALargeTeamHasLongerSetsAndKeepsSixteenFilters) {
  const auto a = started("iu", nav_setup(9, 8, {0, 0}, 2));
  EXPECT_EQ(a->make_payload(0, 300).size(), 14U);
  // Each of five senders doubles the bank: 32.
  for (int sender = 0; sender < 5; ++sender) {
    const auto b = started("iu", nav_setup(9, sender, {-far_m, 0}, 3));
    a->on_range(received_from(sender, b->make_payload(0, 100), far_m));
  }
  const Bytes payload = a->make_payload(0, 300);
  EXPECT_EQ(payload.size(), 16 * 14U);
  // The one of the own vehicle alone is still there, as the worst.
  PayloadReader worst{std::span(payload).last(14)};
  EXPECT_EQ(worst.whole(2), 1U << 8);
}

TEST(InterleavedUpdate, TeamsOfMoreThanThirtyTwoAreRefused) {
  EXPECT_THROW(started("iu", nav_setup(33, 0, {0, 0}, 1)), std::invalid_argument);
}

}  // namespace
