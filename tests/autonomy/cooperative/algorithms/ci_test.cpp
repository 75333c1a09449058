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

TEST(CovarianceIntersection, DoesNotUseARangeThatDoesNotPay) {
  // Inflating a round covariance of 4 by 1 / w costs more than a range to a sender of 9 gives, for all w.
  const auto own = started("ci", nav_setup(2, 0, {0, 0}, 2));
  const auto sender = started("ci", nav_setup(2, 1, {-far_m, 0}, 3));
  own->on_range(received_from(1, sender->make_payload(0, 100), far_m + 1));
  EXPECT_TRUE(own->now(0).P.isApprox(4 * Matrix2::Identity()));
  EXPECT_EQ(own->now(0).p_W.x(), 0);
}

TEST(CovarianceIntersection, InflatesBothByTheWeightOfLeastTrace) {
  const auto own = started("ci", nav_setup(2, 0, {0, 0}, 2));
  const auto sender = started("ci", nav_setup(2, 1, {-far_m, 0}, 0.1));
  own->on_range(received_from(1, sender->make_payload(0, 100), far_m + 1));
  const Estimate estimate = own->now(0);
  const double w = 4 / estimate.P(1, 1);  // across the line P1 = P / w is unchanged
  EXPECT_GT(w, 0.5);
  EXPECT_LT(w, 1);
  const auto along = [](double weight) {
    return 4 / weight - (16 / (weight * weight)) / (4 / weight + 0.01 / (1 - weight) + 1);
  };
  EXPECT_NEAR(estimate.P(0, 0), along(w), 1e-4);
  const double S = 4 / w + 0.01 / (1 - w) + 1;
  EXPECT_NEAR(estimate.p_W.x(), 4 / w / S, 1e-4);
  // No other weight gives less.
  for (double other = 0.02; other < 1; other += 0.02) EXPECT_LE(estimate.P.trace(), 4 / other + along(other) + 1e-4);
}

TEST(CovarianceIntersection, TakesASenderWithSatellitesAsIndependent) {
  const auto own = started("ci", nav_setup(2, 0, {0, 0}, 2));
  const auto sender = started("ci", nav_setup(2, 1, {-far_m, 0}, 1e4));
  sender->fix(0, {-far_m, 0}, 3);
  own->on_range(received_from(1, sender->make_payload(0, 100), far_m + 14));
  EXPECT_NEAR(own->now(0).p_W.x(), 4, 1e-4);  // as naive
}

TEST(CovarianceIntersection, IsNeverTooSureOfCommonInformation) {
  const auto own = started("ci", nav_setup(2, 0, {0, 0}, 2));
  const auto other = started("ci", nav_setup(2, 1, {-far_m, 0}, 3));
  for (int i = 0; i < 100; ++i) {
    own->on_range(received_from(1, other->make_payload(0, 100), far_m, 0.01));
    other->on_range(received_from(0, own->make_payload(0, 100), far_m, 0.01));
  }
  // The best that anyone can know is 1 / (1 / 4 + 1 / 9).
  EXPECT_GE(own->now(0).P(0, 0), 36.0 / 13);
}

}  // namespace
