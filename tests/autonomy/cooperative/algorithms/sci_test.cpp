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

TEST(SplitCovarianceIntersection, IsExactForIndependentSenders) {
  const auto own = started("sci", nav_setup(2, 0, {0, 0}, 2));
  const auto sender = started("sci", nav_setup(2, 1, {-far_m, 0}, 3));
  own->on_range(received_from(1, sender->make_payload(0, 100), far_m + 14));
  // Both have own measurements only: as naive.
  EXPECT_NEAR(own->now(0).p_W.x(), 4, 0.01);
  EXPECT_NEAR(own->now(0).P(0, 0), 4 - 16.0 / 14, 0.01);
}

TEST(SplitCovarianceIntersection, ADependentPartIsInflatedAndStaysDependent) {
  // A sender of Bd = 8 and Bi = 1, R = 1, own Pi = 4: P1 = 4, P2 = 8 / (1 - w) + 1 is least for w = 0.01, the least
  // weight.
  const auto own = started("sci", nav_setup(2, 0, {0, 0}, 2));
  Bytes payload;
  PayloadWriter writer(payload);
  write_position(writer, {{-far_m, 0}, 9 * Matrix2::Identity()});
  write_covariance(writer, Matrix2::Identity());
  own->on_range(received_from(1, payload, far_m + 10));
  const double S = 4 + 8 / 0.99 + 1 + 1, K = 4 / S;
  const Estimate estimate = own->now(0);
  EXPECT_NEAR(estimate.p_W.x(), 10 * K, 1e-3);
  EXPECT_NEAR(estimate.P(0, 0), 4 - 16 / S, 1e-3);
  // Pi+ = (1 - K)^2 4 + K^2 R; what it says is rounded up to 1 cm of the deviation.
  const auto independent_m2 = [](const Bytes& bytes) {
    PayloadReader reader(bytes);
    read_position(reader);
    return (*read_covariance(reader))(0, 0);
  };
  EXPECT_NEAR(independent_m2(own->make_payload(0, 100)), (1 - K) * (1 - K) * 4 + K * K, 0.04);
  EXPECT_NEAR(independent_m2(own->make_payload(0, 100)), 0, 1e-3);  // what it said, others may have
}

TEST(SplitCovarianceIntersection, IsNeverTooSureOfCommonInformation) {
  const auto own = started("sci", nav_setup(2, 0, {0, 0}, 2));
  const auto other = started("sci", nav_setup(2, 1, {-far_m, 0}, 3));
  for (int i = 0; i < 100; ++i) {
    own->on_range(received_from(1, other->make_payload(0, 100), far_m, 0.01));
    other->on_range(received_from(0, own->make_payload(0, 100), far_m, 0.01));
  }
  // The best that anyone can know is 1 / (1 / 4 + 1 / 9).
  EXPECT_GE(own->now(0).P(0, 0), 36.0 / 13 - 0.01);
}

}  // namespace
