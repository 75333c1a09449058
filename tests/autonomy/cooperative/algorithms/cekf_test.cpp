// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "tests/autonomy/cooperative/algorithms/conversation.hpp"

namespace {

using namespace navigation;

using test::nav_second;
using test::nav_setup;
using test::received_from;

class RangeOfATeam : public testing::TestWithParam<const char*> {};

TEST_P(RangeOfATeam, RefersToTheTransmissionAndReachesTheSenderToo) {
  const auto team = algorithm_named(GetParam()).make_team();
  team->start(0, nav_setup(2, 0, {0, 0}, 1));
  team->start(1, nav_setup(2, 1, {test::far_m, 0}, 2));
  team->sent(0, nav_second);
  team->predict(0, 5 * nav_second, {1, 0}, Matrix2::Zero());
  team->on_range(1, received_from(0, {}, test::far_m + 10, std::sqrt(5), nav_second));
  // S = 1 + 4 + 5: the copy of the sender moves by -1 m, and it with the copy.
  EXPECT_NEAR(team->now(0, 5 * nav_second).p_W.x(), 5 - 1, 1e-4);
  EXPECT_NEAR(team->now(1, 5 * nav_second).p_W.x(), test::far_m + 4, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(, RangeOfATeam, testing::Values("cekf", "luft"));

}  // namespace
