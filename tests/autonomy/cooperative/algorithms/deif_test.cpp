// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/autonomy/cooperative/algorithms/centralized_fixture.hpp"

namespace {

using namespace centralized_fixture;
using namespace navigation;

TEST(DecentralizedInformationFilter, IsTheCentralizedFilterWithoutLosses) {
  // Numbers of 4 bytes.
  converse(
      "deif", [](int) { return false; }, 67,
      [](const Estimate& own, const Estimate& team) {
        EXPECT_LT((own.p_W - team.p_W).norm(), 0.01);
        EXPECT_LT((own.P - team.P).norm(), 0.01);
      });
}

TEST(DecentralizedInformationFilter, ToleratesAsManyLossesInARowAsItRepeatsLinks) {
  converse(
      "deif", [](int packet) { return packet % 3 != 0; }, 3 + 3 * 64,
      [](const Estimate& own, const Estimate& team) { EXPECT_LT((own.p_W - team.p_W).norm(), 0.01); });
}

TEST(DecentralizedInformationFilter, IsLessSureAfterTheChainBroke) {
  double max_excess = 0, min_excess = 0;
  converse(
      "deif", [](int packet) { return packet == 60; }, 67,
      [&](const Estimate& own, const Estimate& team) {
        max_excess = std::max(max_excess, own.P.trace() - team.P.trace());
        min_excess = std::min(min_excess, own.P.trace() - team.P.trace());
      });
  EXPECT_GT(max_excess, 0.5);
  EXPECT_GT(min_excess, -0.01);
}

TEST(DecentralizedInformationFilter, KnowsNothingByRoundingAfterTheChainBroke) {
  // The numbers of a link are 1e5 1/m^2 and more with 3 mm of noise in 10 s, rounded to 0.01 1/m^2, of what the link
  // says of its earlier position.
  for (const double server_q : {1e-6, 1e-7, 1e-8})
    for (const int kept_of : {2, 3, 6, 11})
      converse(
          "deif", [&](int packet) { return packet % kept_of != 0; }, 67,
          [&](const Estimate& own, const Estimate& team) {
            const Vector2 off = own.p_W - team.p_W;
            EXPECT_LT(off.dot(own.P.inverse() * off), 13.8) << server_q << ", " << kept_of;  // 99.9 %
          },
          server_q);
}

}  // namespace
